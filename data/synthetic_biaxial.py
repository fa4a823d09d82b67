#!/usr/bin/env python3
"""Makes synthetic_biaxial.csv:  python3 data/synthetic_biaxial.py > data/synthetic_biaxial.csv

A specimen that does not exist: five planar biaxial protocols of an incompressible sheet, F diagonal, nominal stress,
  W = a1 (I1-3) + a2 (I1-3)^2 + a3 (I1-3)^3 + c1/(2 c2) (exp(c2 (I4-1)^2) - 1),  fibres at alpha from x towards z,
plus seeded normal noise of 1 % of the largest stress. Written independently of Langer's own code.
"""
import math
import random

a1, a2, a3, c1, c2, alpha = 0.012, 0.03, 0.01, 0.06, 0.9, 62.0
seed, points, noise = 20240229, 45, 0.01
protocols = {"offx": (0.5, 1.0), "offy": (1.0, 0.5), "equibiaxial": (1.0, 1.0), "stripx": (1.0, 0.0), "stripy": (0.0, 1.0)}
largest_stretch = 0.32


def nominal(lx, lz):
    ly = 1 / (lx * lz)
    x = lx * lx + ly * ly + lz * lz - 3
    w1 = a1 + 2 * a2 * x + 3 * a3 * x * x
    c, s = math.cos(math.radians(alpha)), math.sin(math.radians(alpha))
    y = max(0.0, (lx * c) ** 2 + (lz * s) ** 2 - 1)
    w4 = c1 * y * math.exp(c2 * y * y)
    px = 2 * w1 * (lx - ly * ly / lx) + 2 * w4 * lx * c * c
    pz = 2 * w1 * (lz - ly * ly / lz) + 2 * w4 * lz * s * s
    return px, pz


rows = []
for name, (rx, rz) in protocols.items():
    for i in range(1, points + 1):
        e = largest_stretch * i / points
        lx, lz = 1 + rx * e, 1 + rz * e
        rows.append((name, lx, lz, *nominal(lx, lz)))
deviation = noise * max(max(abs(r[3]), abs(r[4])) for r in rows)
generator = random.Random(seed)
print("# SYNTHETIC, not measured: made by synthetic_biaxial.py from an incompressible HGO-Yeoh law with")
print(f"# a1 = {a1} MPa, a2 = {a2} MPa, a3 = {a3} MPa, c1 = {c1} MPa, c2 = {c2}, alpha = {alpha} degrees from x towards z")
print(f"# plus normal noise with a standard deviation of {deviation:.6g} MPa (1 % of the largest stress), seed {seed}.")
print("# Five planar biaxial protocols; stretches, and nominal stresses in MPa.")
print("# ---")
print("# kind: biaxial")
print("# columns: {strain_x: lambda_x, strain_z: lambda_z, stress_x: P_x_MPa, stress_z: P_z_MPa}")
print("# strain: stretch")
print("# stress: nominal")
print("# split: protocol            # one test for each")
print("# ---")
print("protocol,lambda_x,lambda_z,P_x_MPa,P_z_MPa")
for name, lx, lz, px, pz in rows:
    print(f"{name},{lx:.6f},{lz:.6f},{px + generator.gauss(0, deviation):.6f},{pz + generator.gauss(0, deviation):.6f}")
