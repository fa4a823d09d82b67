#!/usr/bin/env python3
"""Makes synthetic_population.csv and synthetic_population_specimens.csv:  python3 data/synthetic_population.py [seed] [folder]

Thirty specimens that do not exist, three planar biaxial protocols each. An incompressible sheet, F diagonal, nominal stress,
  W = a1 (I1-3) + c1/(2 c2) (exp(c2 (I4-1)^2) - 1),  fibres at alpha from x towards z.
Between specimens ln a1, ln c1, ln c2 and alpha are normal; ln a1 and ln c1 are correlated by 0.8. Written independently of
Langer's own code.
"""
import math
import os
import random
import sys

seed = int(sys.argv[1]) if len(sys.argv) > 1 else 20261126
folder = sys.argv[2] if len(sys.argv) > 2 else os.path.dirname(os.path.abspath(__file__))
specimens, points, noise, largest_stretch = 30, 10, 0.01, 0.3
median = {"a1": 0.012, "c1": 0.06, "c2": 1.2, "alpha": 35.0}
scatter = {"a1": 0.35, "c1": 0.45, "c2": 0.25, "alpha": 4.0}  # of the logarithm; of alpha degrees
correlation = 0.8  # of ln a1 and ln c1
protocols = {"equibiaxial": (1.0, 1.0), "offx": (1.0, 0.5), "offz": (0.5, 1.0)}
generator = random.Random(seed)


def nominal(p, lx, lz):
    ly = 1 / (lx * lz)
    c, s = math.cos(math.radians(p["alpha"])), math.sin(math.radians(p["alpha"]))
    y = max(0.0, (lx * c) ** 2 + (lz * s) ** 2 - 1)
    w4 = p["c1"] * y * math.exp(p["c2"] * y * y)
    px = 2 * p["a1"] * (lx - ly * ly / lx) + 2 * w4 * lx * c * c
    pz = 2 * p["a1"] * (lz - ly * ly / lz) + 2 * w4 * lz * s * s
    return px, pz


def specimen():
    z = [generator.gauss(0, 1) for _ in range(4)]
    p = {"a1": median["a1"] * math.exp(scatter["a1"] * z[0])}
    p["c1"] = median["c1"] * math.exp(scatter["c1"] * (correlation * z[0] + math.sqrt(1 - correlation**2) * z[1]))
    p["c2"] = median["c2"] * math.exp(scatter["c2"] * z[2])
    p["alpha"] = median["alpha"] + scatter["alpha"] * z[3]
    return p


typical = max(max(nominal(median, 1 + rx * largest_stretch, 1 + rz * largest_stretch)) for rx, rz in protocols.values())
deviation = noise * typical
with open(os.path.join(folder, "synthetic_population_specimens.csv"), "w") as table:
    print("id,age", file=table)
    with open(os.path.join(folder, "synthetic_population.csv"), "w") as out:
        print(f"# SYNTHETIC, not measured: made by synthetic_population.py, seed {seed}. Medians", *[f"{k} = {v}" for k, v in median.items()], file=out)
        print("# scatter between specimens", *[f"{k} {v}" for k, v in scatter.items()], f"(of logarithms; alpha in degrees), ln a1 and ln c1 correlated by {correlation}", file=out)
        print(f"# normal noise of {deviation:.6g} MPa; nominal stresses of incompressible neo-Hooke with HGO fibres", file=out)
        print("# ---", file=out)
        print("# kind: biaxial", file=out)
        print("# columns: {strain_x: lambda_x, strain_z: lambda_z, stress_x: P_x_MPa, stress_z: P_z_MPa}", file=out)
        print("# strain: stretch", file=out)
        print("# stress: nominal", file=out)
        print("# ---", file=out)
        print("specimen,test,lambda_x,lambda_z,P_x_MPa,P_z_MPa", file=out)
        for number in range(1, specimens + 1):
            name, p = f"S{number:02d}", specimen()
            print(f"{name},{generator.randint(20, 79)}", file=table)
            for test, (rx, rz) in protocols.items():
                for i in range(1, points + 1):
                    e = largest_stretch * i / points
                    lx, lz = 1 + rx * e, 1 + rz * e
                    px, pz = nominal(p, lx, lz)
                    print(f"{name},{test},{lx:.5f},{lz:.5f},{px + generator.gauss(0, deviation):.6f},{pz + generator.gauss(0, deviation):.6f}", file=out)
