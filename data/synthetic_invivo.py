#!/usr/bin/env python3
"""Makes synthetic_invivo_force.csv and synthetic_invivo_field.csv from a solution of configs/solve/invivo_extension.yaml:

    langer-solve configs/solve/invivo_extension.yaml --set path.steps=17 -o twin/solution.h5
    langer-post configs/post/invivo_extension.yaml --solution twin/solution.h5 -o twin/curves.h5
    python3 data/synthetic_invivo.py twin data

adds seeded normal noise, 5 mN to the force and 0.02 mm to the displacements between the pads.
"""
import csv
import random
import sys

source, target = sys.argv[1], sys.argv[2]
generator = random.Random(20240302)
head = ["# SYNTHETIC, not measured: made by synthetic_invivo.py from configs/solve/invivo_extension.yaml; x from the middle of",
        "# the moving pad towards the fixed one, y across: the form of the measured test of Sutula et al. (2020)."]


def rows(name):
    with open(f"{source}/{name}.csv") as f:
        return [[float(x) for x in row.values()] for row in csv.DictReader(f)]


with open(f"{target}/synthetic_invivo_force.csv", "w") as out:
    print(*head, "# Noise of 5 mN.", "u_pad_mm,force_N", sep="\n", file=out)
    for u, force in rows("curves")[1:]:
        print(f"{u:.4f},{force + generator.gauss(0, 0.005):.5f}", file=out)
with open(f"{target}/synthetic_invivo_field.csv", "w") as out:
    print(*head, "# Noise of 0.02 mm.", "u_pad_mm,x_mm,y_mm,ux_mm,uy_mm", sep="\n", file=out)
    for pad, along, across in ((-1, "ux_1", "uz_1"), (-4, "ux_4", "uz_4")):
        for (x, z, ux), (_, _, uz) in zip(rows(along), rows(across)):
            if 10 <= x <= 30 and abs(z) <= 4:
                print(f"{pad},{x:.3f},{z:.3f},{ux + generator.gauss(0, 0.02):.5f},{uz + generator.gauss(0, 0.02):.5f}", file=out)
