#!/usr/bin/env python3
"""A rigid sphere pulled off an elastic half-space, with the bonds of lib/mechanics/contact/adhesion.hpp, by boundary elements:

    python3 tests/peers/half_space.py STIFFNESS [TOUCHED] [RINGS]         MPa/mm, mm, rings in 1.15 TOUCHED; scene of configs/solve/pull_off.yaml

prints the greatest pull, that of Johnson, Kendall and Roberts, 3/2 pi w R, and lambda of Maugis (1992). Linear elasticity: the displacement of a
ring of uniform pressure is a difference of two discs' (Johnson, Contact Mechanics, 3.4). Needs numpy and scipy."""
import sys

import numpy as np
from scipy.special import ellipe, ellipk

RADIUS, WORK, E_STAR = 5.0, 5.0e-4, 0.4  # mm, N/mm, MPa: 4 mu of an incompressible body


def disc(a, r):
    """surface displacement at r under unit pressure on a disc of radius a, for E* = 1"""
    u = np.empty_like(r)
    within = r <= a
    k = r[within] / a
    u[within] = 4 * a / np.pi * ellipe(k**2)
    k = a / r[~within]
    u[~within] = 4 * r[~within] / np.pi * (ellipe(k**2) - (1 - k**2) * ellipk(k**2))
    return u


class Sphere:
    def __init__(self, stiffness, touched, rings):
        edges = np.linspace(0, 1.15 * touched, rings + 1)
        self.r, self.area = 0.5 * (edges[1:] + edges[:-1]), np.pi * np.diff(edges**2)
        discs = np.array([disc(a, self.r) if a > 0 else 0 * self.r for a in edges]).T
        self.compliance = np.diff(discs) / E_STAR
        self.stiffness, self.opening = stiffness, np.sqrt(WORK / stiffness)
        self.touched, self.bonded = touched, self.r <= touched

    def bond(self, gap):
        """stress [MPa] and its derivative; bonds only ever open here"""
        far = np.maximum(gap, self.opening)
        stress = np.where(gap < self.opening, self.stiffness * np.maximum(gap, 0), WORK**2 / (self.stiffness * far**3))
        slope = np.where(gap < self.opening, self.stiffness * (gap > 0), -3 * WORK**2 / (self.stiffness * far**4))
        return self.bonded * stress, self.bonded * slope

    def equilibrium(self, pressure, depth):
        """Newton's method on: pressure = reaction - bond stress, reaction >= 0, gap >= 0, reaction gap = 0. None where it does not end."""
        c = 1 / np.diag(self.compliance)
        for _ in range(40):
            gap = self.r**2 / (2 * RADIUS) - depth + self.compliance @ pressure
            stress, slope = self.bond(gap)
            reaction = pressure + stress
            closed = reaction > c * gap
            residual = np.where(closed, c * gap, reaction)
            if np.abs(residual).max() < 1e-11:
                return pressure
            tangent = np.where(closed[:, None], c[:, None] * self.compliance, np.eye(len(c)) + slope[:, None] * self.compliance)
            pressure = pressure - np.linalg.solve(tangent, residual)
        return None

    def greatest_pull(self):
        depth = self.touched**2 / RADIUS  # Hertz
        state = 2 * E_STAR / (np.pi * RADIUS) * np.sqrt(np.maximum(self.touched**2 - self.r**2, 0))
        longest = depth / 60
        step, before, greatest = longest, None, 0.0
        while step > 1e-3 * longest:
            guess = state if before is None else state + (state - before[0]) * step / before[1]
            found = self.equilibrium(guess, depth - step)
            if found is None:  # beyond the last equilibrium the sphere jumps off
                step /= 2
                continue
            depth, before, state = depth - step, (state, step), found
            pull = -state @ self.area
            greatest = max(greatest, pull)
            if 0 < pull < 0.9 * greatest:
                break
            step = min(1.5 * step, longest)
        return greatest


def main(stiffness, touched=0.77, rings=300):
    pull = Sphere(stiffness, touched, rings).greatest_pull()
    jkr = 1.5 * np.pi * WORK * RADIUS
    k = 4 / 3 * E_STAR
    maugis = 2 * np.sqrt(WORK * stiffness) * (RADIUS / (np.pi * WORK * k**2)) ** (1 / 3)
    print(f"stiffness {stiffness:g} MPa/mm, lambda {maugis:.2f}: pull {pull:.5f} N, {100 * (pull / jkr - 1):+.1f} % beside {jkr:.5f} N")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(float(sys.argv[1]), *(float(x) for x in sys.argv[2:3]), *(int(x) for x in sys.argv[3:4]))
