#!/usr/bin/env python3
"""Makes synthetic_tensile.csv:  python3 data/synthetic_tensile.py > data/synthetic_tensile.csv

A specimen that does not exist: uniaxial tension along the fibres of an incompressible sheet, nominal stress,
  W = a1 (I1-3) + a2 (I1-3)^2 + a3 (I1-3)^3 + c1/(2 c2) (exp(c2 (I4-1)^2) - 1),
plus seeded normal noise of 1 % of the largest stress. Written independently of Langer's own code.
"""
import math
import random

a1, a2, a3, c1, c2 = 0.012, 0.03, 0.01, 0.06, 0.9
seed, points, noise, largest_stretch = 20240301, 40, 0.01, 1.4


def nominal(l):
    x = l * l + 2 / l - 3
    w1 = a1 + 2 * a2 * x + 3 * a3 * x * x
    y = l * l - 1
    return 2 * w1 * (l - 1 / (l * l)) + 2 * c1 * y * math.exp(c2 * y * y) * l


stretches = [1 + (largest_stretch - 1) * i / points for i in range(1, points + 1)]
stresses = [nominal(l) for l in stretches]
deviation = noise * max(stresses)
generator = random.Random(seed)
print("# SYNTHETIC, not measured: made by synthetic_tensile.py from an incompressible HGO-Yeoh law with")
print(f"# a1 = {a1} MPa, a2 = {a2} MPa, a3 = {a3} MPa, c1 = {c1} MPa, c2 = {c2}, fibres along the specimen,")
print(f"# plus normal noise with a standard deviation of {deviation:.6g} MPa (1 % of the largest stress), seed {seed}.")
print("stretch,nominal_stress_MPa")
for l, stress in zip(stretches, stresses):
    print(f"{l:.6f},{stress + generator.gauss(0, deviation):.8f}")
