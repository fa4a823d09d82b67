#!/usr/bin/env python3
"""How often 95 % intervals of HGO-Yeoh's five numbers hold the truth: a tensile curve and two block indentations with friction (the fit of
pipelines/inverse_indentation.yaml), with fresh noise of 1 % in all three for every seed.

    python3 tests/bench/coverage_indentation.py build/bin 1 100        # first and last seed; about a CPU minute for twenty of them
"""
import csv
import math
import os
import random
import subprocess
import sys
import tempfile

programs, first, last = os.path.abspath(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
project = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
names, true = ["a1", "a2", "a3", "c1", "c2"], [0.012, 0.03, 0.01, 0.06, 0.9]


def nominal(l):
    a1, a2, a3, c1, c2 = true
    x, y = l * l + 2 / l - 3, l * l - 1
    return 2 * (a1 + 2 * a2 * x + 3 * a3 * x * x) * (l - 1 / (l * l)) + 2 * c1 * y * math.exp(c2 * y * y) * l


def run(program, *arguments):
    subprocess.run([f"{programs}/langer-{program}", *arguments, "--quiet"], check=True)


def force_at(angle, folder):
    run("solve", f"{project}/configs/solve/inverse_block.yaml", "--set", f"material.fibres[0].alpha={angle}", "-o", f"{folder}/solution.h5")
    run("post", f"{project}/configs/post/inverse_yeoh.yaml", "--solution", f"{folder}/solution.h5", "-o", f"{folder}/curves.h5")
    with open(f"{folder}/curves.csv") as f:
        return [tuple(map(float, row)) for row in list(csv.reader(f))[2:]]


def scene(angle, deviation):
    return (f"  - {{kind: scene, name: at_{angle}, solve: {project}/configs/solve/inverse_block.yaml, file: at_{angle}.csv, fibre_angle: {angle},\n"
            f"     columns: {{u_ind: u_ind_mm, force: force_N}}, standard_deviation: {deviation}}}\n")


with tempfile.TemporaryDirectory() as folder:
    forces = {angle: force_at(angle, folder) for angle in (0, 90)}
    stretches = [1 + 0.4 * i / 40 for i in range(1, 41)]
    deviation = 0.01 * nominal(1.4)
    of_force = {angle: 0.01 * curve[-1][1] for angle, curve in forces.items()}
    fit = f"data:\n  - {{file: tensile.csv, standard_deviation: {deviation}}}\n" + scene(0, of_force[0]) + scene(90, of_force[90])
    fit += "law: {matrix: {yeoh: {a1: 0.013, a2: 0.03, a3: 0.012}}, fibres: [{hgo: {c1: 0.055, c2: 0.9}, alpha: 0}], volume: {quadratic: {d: 1.0e-3}}}\n"
    fit += "parameters:\n  - {key: matrix.yeoh.a1, lower: 0.001, upper: 1}\n  - {key: matrix.yeoh.a2, lower: 0, upper: 1}\n"
    fit += "  - {key: matrix.yeoh.a3, lower: 0, upper: 1}\n  - {key: \"fibres[0].hgo.c1\", lower: 0, upper: 1}\n"
    fit += "  - {key: \"fibres[0].hgo.c2\", lower: 0, upper: 10}\ndraft: false\n"
    with open(f"{folder}/fit.yaml", "w") as f:
        f.write(fit)
    held, on_bound = [0] * 5, 0
    for seed in range(first, last + 1):
        generator = random.Random(seed)
        with open(f"{folder}/tensile.csv", "w") as f:
            f.write("stretch,nominal_stress_MPa\n")
            for l in stretches:
                f.write(f"{l:.6f},{nominal(l) + generator.gauss(0, deviation):.8f}\n")
        for angle, curve in forces.items():
            with open(f"{folder}/at_{angle}.csv", "w") as f:
                f.write("u_ind_mm,force_N\n")
                for u, force in curve:
                    f.write(f"{u},{force + generator.gauss(0, of_force[angle])}\n")
        run("fit", f"{folder}/fit.yaml", "-o", f"{folder}/material.h5")
        with open(f"{folder}/parameters.csv") as f:
            rows = list(csv.DictReader(f))
        for i, row in enumerate(rows):
            held[i] += float(row["lower_95"]) <= true[i] <= float(row["upper_95"])
        on_bound += any(row["standard_error"] == "" for row in rows)
    seeds = last - first + 1
    print(f"{seeds} seeds, a parameter on its bound in {on_bound}: 95 % intervals hold " +
          ", ".join(f"{name} {100 * n / seeds:.0f} %" for name, n in zip(names, held)))
