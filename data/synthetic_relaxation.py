#!/usr/bin/env python3
"""Makes synthetic_relaxation.csv:  python3 data/synthetic_relaxation.py > data/synthetic_relaxation.csv

A specimen that does not exist, pulled along its fibres: two ramps with holds and a cycle. Incompressible,
  W = a1 (I1-3) + a2 (I1-3)^2 + a3 (I1-3)^3 + c1/(2 c2) (exp(c2 (I4-1)^2) - 1)  after all has relaxed,
  S = S_iso + sum Q_i,  Q_i' + Q_i/tau_i = gamma_i S_iso',
plus seeded normal noise of 0.5 % of the largest stress. Written independently of Langer's own code, in steps 40 times as short.
"""
import math
import random

a1, a2, a3, c1, c2 = 0.012, 0.03, 0.01, 0.06, 0.9
branches = [(0.1, 0.25), (1.0, 0.2), (10.0, 0.3)]
seed, noise, finer = 20240301, 0.005, 40


def isochoric(l):
    """second Piola-Kirchhoff stress, along and across, of a stretch l"""
    t = 1 / math.sqrt(l)
    i1 = l * l + 2 * t * t
    x = i1 - 3
    w1 = a1 + 2 * a2 * x + 3 * a3 * x * x
    y = max(0.0, l * l - 1)
    w4 = c1 * y * math.exp(c2 * y * y)
    along = 2 * w1 * (1 - i1 / 3 / l**2) + 2 * w4 * (1 - 1 / 3)
    across = 2 * w1 * (1 - i1 / 3 / t**2) + 2 * w4 * (-l * l / 3 / t**2)
    return along, across


# (until second, stretch then, readings): straight between
history = [(0.2, 1.15, 10), (30.2, 1.15, 45), (30.6, 1.3, 10), (90.6, 1.3, 50), (92.6, 1.0, 15), (94.6, 1.3, 15), (96.6, 1.0, 15)]
time, stretch, rows = 0.0, 1.0, [(0.0, 1.0, 0.0)]
stress, q = isochoric(1.0), [[0.0, 0.0] for _ in branches]
for until, to, readings in history:
    begin, start = time, stretch
    hold = to == start
    for k in range(1, readings + 1):
        share = (math.expm1(5 * k / readings) / math.expm1(5)) if hold else k / readings
        t0, t1 = time, begin + share * (until - begin)
        for j in range(1, finer + 1):
            now = t0 + (t1 - t0) * j / finer
            l = start + (to - start) * (now - begin) / (until - begin)
            after = isochoric(l)
            for (tau, gamma), one in zip(branches, q):
                # midpoint rule
                keep = math.exp(-(now - time) / tau)
                for c in (0, 1):
                    one[c] = keep * one[c] + gamma * math.sqrt(keep) * (after[c] - stress[c])
            stress, time = after, now
        stretch = l
        along, across = (stress[c] + sum(one[c] for one in q) for c in (0, 1))
        rows.append((time, stretch, (stretch**2 * along - across / stretch) / stretch))
deviation = noise * max(abs(r[2]) for r in rows)
generator = random.Random(seed)
print("# SYNTHETIC, not measured: made by synthetic_relaxation.py from an incompressible HGO-Yeoh law with")
print(f"# a1 = {a1} MPa, a2 = {a2} MPa, a3 = {a3} MPa, c1 = {c1} MPa, c2 = {c2}, pulled along its fibres, and branches")
print("# " + ", ".join(f"tau = {tau:g} s with gamma = {gamma:g}" for tau, gamma in branches))
print(f"# plus normal noise with a standard deviation of {deviation:.6g} MPa (0.5 % of the largest stress), seed {seed}.")
print("# Two ramps with holds and a cycle; stretch, and nominal stress in MPa.")
print("# ---")
print("# kind: uniaxial")
print("# columns: {time: t_s, strain_x: lambda, stress_x: P_MPa}")
print("# strain: stretch")
print("# stress: nominal")
print("# ---")
print("t_s,lambda,P_MPa")
for t, l, p in rows:
    print(f"{t:.5f},{l:.6f},{p + generator.gauss(0, deviation):.6f}")
