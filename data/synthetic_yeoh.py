#!/usr/bin/env python3
"""Makes synthetic_yeoh.csv:  python3 data/synthetic_yeoh.py > data/synthetic_yeoh.csv

A specimen that does not exist: uniaxial tension of an incompressible isotropic sheet, nominal stress,
  W = a1 (I1-3) + a2 (I1-3)^2 + a3 (I1-3)^3,
plus seeded normal noise of 1 % of the largest stress. Written independently of Langer's own code.
"""
import random

a1, a2, a3 = 0.012, 0.03, 0.01
seed, points, noise, largest_stretch = 1, 60, 0.01, 1.6


def nominal(l):
    x = l * l + 2 / l - 3
    return 2 * (a1 + 2 * a2 * x + 3 * a3 * x * x) * (l - 1 / (l * l))


stretches = [1 + (largest_stretch - 1) * i / points for i in range(1, points + 1)]
stresses = [nominal(l) for l in stretches]
deviation = noise * max(stresses)
generator = random.Random(seed)
print("# SYNTHETIC, not measured: made by synthetic_yeoh.py from an incompressible Yeoh law with")
print(f"# a1 = {a1} MPa, a2 = {a2} MPa, a3 = {a3} MPa,")
print(f"# plus normal noise with a standard deviation of {deviation:.6g} MPa (1 % of the largest stress), seed {seed}.")
print("stretch,nominal_stress_MPa")
for l, stress in zip(stretches, stresses):
    print(f"{l:.6f},{stress + generator.gauss(0, deviation):.8f}")
