#!/usr/bin/env python3
"""How often the 95 % intervals of a population hold the truth, and the bias of three ways to find it: the fit with mixed effects, the
average of fits, the fit of the mean curve. Synthetic populations of data/synthetic_population.py, one for each seed.

    python3 tests/bench/coverage_population.py build/bin 1001 1100     # first and last seed; prints the table of docs/population.md
"""
import csv
import math
import os
import subprocess
import sys
import tempfile

programs, first, last = os.path.abspath(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
project = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# as in data/synthetic_population.py; coefficients of variation of the three that are lognormal, and of the angle
cv = {name: math.sqrt(math.exp(s * s) - 1) for name, s in (("a1", 0.35), ("c1", 0.45), ("c2", 0.25))} | {"alpha": 4 / 35}
ways = ["population_median", "average_of_fits", "fit_of_mean_curve"]

with open(f"{project}/configs/fit/population.yaml") as file:
    config = file.read().replace("../../data/", "").replace("# yaml-language-server", "#")

bias, held, scatter_held = {}, {}, {}
correlation_held = 0
with tempfile.TemporaryDirectory() as folder:
    with open(f"{folder}/fit.yaml", "w") as file:
        file.write(config)
    for seed in range(first, last + 1):
        subprocess.run([sys.executable, f"{project}/data/synthetic_population.py", str(seed), folder], check=True)
        subprocess.run([f"{programs}/langer-fit", f"{folder}/fit.yaml", "-o", f"{folder}/material.h5", "--quiet"], check=True, stderr=subprocess.DEVNULL)
        with open(f"{folder}/population.csv") as file:
            for row in csv.DictReader(line for line in file if not line.startswith("#")):
                name, true = row["parameter"], float(row["true"])
                for way in ways:
                    bias.setdefault((name, way), []).append(100 * (float(row[way]) / true - 1))
                held[name] = held.get(name, 0) + (float(row["lower_95"]) <= true <= float(row["upper_95"]))
                scatter_held[name] = scatter_held.get(name, 0) + (float(row["cv_lower_95"]) <= cv[name] <= float(row["cv_upper_95"]))
        with open(f"{folder}/correlations.csv") as file:
            for row in csv.DictReader(file):
                if {row["parameter"], row["other"]} == {"a1", "c1"}:
                    correlation_held += float(row["lower_95"]) <= 0.8 <= float(row["upper_95"])

n = last - first + 1
print(f"{n} populations, intervals in % of them; the correlation of a1 and c1 was in its interval {correlation_held} times\n")
print("| parameter | mixed model | average of fits | fit of the mean curve | median in its interval | scatter in its interval |")
print("| --- | --- | --- | --- | --- | --- |")
for name in held:
    means = " | ".join(f"{sum(bias[name, way]) / n:+.1f} %" for way in ways)
    print(f"| {name} | {means} | {100 * held[name] / n:.0f} | {100 * scatter_held[name] / n:.0f} |")
