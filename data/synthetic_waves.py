#!/usr/bin/env python3
"""Makes synthetic_waves.csv:  python3 data/synthetic_waves.py > data/synthetic_waves.csv

Skin that does not exist: a thick sheet of an incompressible neo-Hooke material with one family of fibres,
  W = a1 (I1-3) + c1/(2 c2) (exp(c2 (I4-1)^2) - 1),
stretched along x, the fibres at an angle to x. The speed of its surface wave over the direction, plus
seeded normal noise. Written independently of Langer's own code: the moduli are differences of W(F), and
the wave is where the stiffness of the surface, of three decaying waves exp(i k x' + s k y), is singular. Needs numpy.
"""
import math
import random

import numpy as np

a1, c1, c2, fibre_angle = 0.010, 0.030, 0.9, 20.0  # MPa, MPa, -, degrees
along, across, density = 1.12, 1.0, 1100.0  # stretches, kg/m3
seed, deviation, step = 20261126, 0.03, 10  # -, m/s, degrees


def energy(F):
    a = np.array([math.cos(math.radians(fibre_angle)), 0, math.sin(math.radians(fibre_angle))])
    J = np.linalg.det(F)
    I1 = J ** (-2 / 3) * np.trace(F.T @ F)
    I4 = J ** (-2 / 3) * (F @ a) @ (F @ a)
    fibre = c1 / (2 * c2) * (math.exp(c2 * (I4 - 1) ** 2) - 1) if I4 > 1 else 0.0
    return a1 * (I1 - 3) + fibre


def moduli(F):
    """Second derivative of W((1 + H) F) by H, central differences, with the pressure that
    frees the surface."""
    h = 1e-4
    unit = np.eye(9).reshape(9, 3, 3)
    A = np.zeros((9, 9))
    for m in range(9):
        for n in range(9):
            total = 0.0
            for p in (1, -1):
                for q in (1, -1):
                    total += p * q * energy((np.eye(3) + h * (p * unit[m] + q * unit[n])) @ F)
            A[m, n] = total / (4 * h * h)
    slope = (energy((np.eye(3) + h * unit[4]) @ F) - energy((np.eye(3) - h * unit[4]) @ F)) / (2 * h)
    A = A.reshape(3, 3, 3, 3)  # A[i, p, j, q] of u_i,p u_j,q
    for i in range(3):
        for p in range(3):
            A[i, p, p, i] += slope
    return A


def surface(A, angle, rho_c2):
    """Smallest stiffness of the surface, of the three waves that decay with the depth."""
    n = np.array([math.cos(angle), 0, math.sin(angle)])
    m = np.array([0.0, 1.0, 0.0])
    Q = np.einsum("ipjq,p,q", A, n, n)
    R = np.einsum("ipjq,p,q", A, n, m)
    T = np.einsum("ipjq,p,q", A, m, m)
    # (s^2 T + i s (R + R') - Q + rho c^2) u - (i n + s m) q = 0,  (i n + s m) u = 0
    M2, M1, M0 = np.zeros((3, 4, 4), complex)
    M2[:3, :3] = T
    M1[:3, :3] = 1j * (R + R.T)
    M0[:3, :3] = -Q + rho_c2 * np.eye(3)
    M1[:3, 3], M0[:3, 3] = -m, -1j * n
    M1[3, :3], M0[3, :3] = m, 1j * n

    def at(s):
        return s * s * M2 + s * M1 + M0

    # det is a polynomial of degree 6 in s: from its values at 7 places
    places = np.exp(2j * np.pi * np.arange(7) / 7)
    coefficients = np.fft.fft([np.linalg.det(at(s)) for s in places]) / 7
    roots = np.roots(coefficients[::-1])
    decaying = sorted(roots, key=lambda s: -s.real)[:3]
    tractions, motions = [], []
    for s in decaying:
        _, _, vh = np.linalg.svd(at(s))
        u, q = vh[-1].conj()[:3], vh[-1].conj()[3]
        tractions.append(s * T @ u + 1j * R.T @ u - q * m)
        motions.append(u)
    stiffness = np.linalg.solve(np.array(motions), np.array(tractions))  # of the surface
    slowest = min(s.real for s in decaying)
    return np.linalg.svd(stiffness)[1][-1] / np.abs(A).max(), slowest


def speed(A, angle):
    """Smallest c of a surface wave [m/s]: where that stiffness is 0."""
    best = None
    stiff = A.reshape(9, 9).diagonal().max()
    grid = np.linspace(0.02 * stiff, 1.5 * stiff, 1500)
    values = [surface(A, angle, x) for x in grid]
    for i in range(1, len(grid) - 1):
        if values[i][1] < 1e-6:
            break
        if values[i][0] < values[i - 1][0] and values[i][0] < values[i + 1][0]:
            low, high = grid[i - 1], grid[i + 1]
            for _ in range(80):
                a, b = low + (high - low) * 0.382, low + (high - low) * 0.618
                if surface(A, angle, a)[0] < surface(A, angle, b)[0]:
                    high = b
                else:
                    low = a
            x = 0.5 * (low + high)
            if surface(A, angle, x)[0] < 1e-5:
                best = math.sqrt(x * 1e6 / density)
                break
    return best


if __name__ == "__main__":
    F = np.diag([along, 1 / (along * across), across])
    A = moduli(F)
    generator = random.Random(seed)
    print("# SYNTHETIC, not measured: made by synthetic_waves.py from an incompressible law with")
    print(f"# a1 = {a1} MPa, c1 = {c1} MPa, c2 = {c2}, fibres at {fibre_angle} degrees, density {density} kg/m3,")
    print(f"# stretched by {along} along x and {across} across, plus normal noise with a standard deviation of {deviation} m/s,")
    print(f"# seed {seed}. Speed of the surface wave over its direction from x towards z.")
    print("angle_deg,speed_m_s")
    for angle in range(0, 180, step):
        c = speed(A, math.radians(angle))
        print(f"{angle},{c + generator.gauss(0, deviation):.4f}")
