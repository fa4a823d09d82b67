#!/usr/bin/env python3
"""Makes synthetic_invivo_relaxation.csv:  python3 data/synthetic_invivo_relaxation.py > data/synthetic_invivo_relaxation.csv

Skin that does not exist between two pads, as one test in vivo was done: four ramps of 9.45 mm at 1 mm/s, each held for 60 s, and back.
Uniaxial, incompressible,
  W = a1 (I1-3) + a3 (I1-3)^3  after all has relaxed,
  S = S_iso + sum Q_i,  Q_i' + Q_i/tau_i = gamma_i S_iso',
in the first cycle stiffer in all (preconditioning, which no branch describes), plus an offset of the device and seeded normal noise.
Written independently of Langer's own code, in steps 10 times as short as the readings.
"""
import math
import random

a1, a3 = 0.008, 0.06                                   # MPa
branches = [(0.5, 0.6), (15.0, 0.4)]                   # s, -
first_cycle = 1.25
length, area = 30.0, 15.0                              # mm between the pads at rest, mm^2 across the force
travel, speed, hold, rest = 9.45, 1.0, 60.0, 9.5       # mm, mm/s, s, s
offset, deviation, seed = -0.07, 0.003, 20240303       # N
every, finer = 0.5, 10                                 # s between two readings


def isochoric(l):
    """second Piola-Kirchhoff stress, along and across, of a stretch l"""
    i1 = l * l + 2 / l
    w1 = a1 + 3 * a3 * (i1 - 3) ** 2
    return 2 * w1 * (1 - i1 / 3 / l**2), 2 * w1 * (1 - i1 / 3 * l)


corners = [(0.0, 0.0), (rest, 0.0)]                    # s, mm
for cycle in range(4):
    corners.append((corners[-1][0] + travel / speed, travel))
    corners.append((corners[-1][0] + hold, travel))
    corners.append((corners[-1][0] + travel / speed, 0.0))
end_of_first = corners[4][0]


def pad(t):
    for (t0, u0), (t1, u1) in zip(corners, corners[1:]):
        if t <= t1:
            return u0 + (u1 - u0) * (t - t0) / (t1 - t0)
    return corners[-1][1]


generator = random.Random(seed)
print("# SYNTHETIC, not measured: made by synthetic_invivo_relaxation.py, skin between two pads that are 30 mm apart at rest. After all has")
print(f"# relaxed a1 = {a1} MPa, a3 = {a3} MPa over {area:g} mm^2, branches " +
      ", ".join(f"tau = {tau:g} s with gamma = {gamma:g}" for tau, gamma in branches) + f"; {first_cycle} times as")
print(f"# stiff in the first cycle. Offset {offset} N, noise of {1000 * deviation:g} mN.")
print("t_s,u_pad_mm,force_N")
time, stress, q = 0.0, isochoric(1.0), [[0.0, 0.0] for _ in branches]
for k in range(int(corners[-1][0] / every) + 1):
    while time < k * every - 1e-9:
        now = time + every / finer
        after = isochoric(1 + pad(now) / length)
        for (tau, gamma), one in zip(branches, q):
            keep = math.exp(-(now - time) / tau)
            for c in (0, 1):
                one[c] = keep * one[c] + gamma * math.sqrt(keep) * (after[c] - stress[c])  # midpoint rule
        stress, time = after, now
    l = 1 + pad(time) / length
    along, across = (stress[c] + sum(one[c] for one in q) for c in (0, 1))
    force = area * (l**2 * along - across / l) / l * (first_cycle if time <= end_of_first else 1)
    print(f"{time:.2f},{pad(time):.3f},{force + offset + generator.gauss(0, deviation):.4f}")
