#!/usr/bin/env python3
"""How the noise of synthetic_tensile.csv lies to what parameters can do to the curve:  python3 data/noise_of_tensile.py

Over orthonormal directions of the five columns d stress/d parameter, in standard deviations of the noise; their sum of squares is a chi-square
of five degrees of freedom (95 % are below 11.07) where the noise is as any other.
"""
import math
import random

a1, a2, a3, c1, c2 = true = [0.012, 0.03, 0.01, 0.06, 0.9]
stretches = [1 + 0.4 * i / 40 for i in range(1, 41)]


def nominal(l, p):
    a1, a2, a3, c1, c2 = p
    x, y = l * l + 2 / l - 3, l * l - 1
    return 2 * (a1 + 2 * a2 * x + 3 * a3 * x * x) * (l - 1 / (l * l)) + 2 * c1 * y * math.exp(c2 * y * y) * l


directions = []
for i in range(5):
    h = 1e-5 * true[i]
    above, below = list(true), list(true)
    above[i] += h
    below[i] -= h
    column = [(nominal(l, above) - nominal(l, below)) / (2 * h) for l in stretches]
    for d in directions + directions:
        part = sum(a * b for a, b in zip(column, d))
        column = [a - part * b for a, b in zip(column, d)]
    size = math.sqrt(sum(a * a for a in column))
    directions.append([a / size for a in column])
for seed in [20240301] + list(range(1, 9)):
    generator = random.Random(seed)
    noise = [generator.gauss(0, 1) for _ in stretches]
    z = [sum(a * b for a, b in zip(noise, d)) for d in directions]
    print(f"seed {seed}: {' '.join(f'{x:6.2f}' for x in z)}   chi-square {sum(x * x for x in z):.1f}")
