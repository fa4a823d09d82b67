#!/usr/bin/python3
"""make contact-discretisations: which discretisation of contact with friction is nearest to the limit, and what its error is.

A linear elastic, nearly incompressible layer on a rigid base, axisymmetric, on bilinear cells with the mean dilatation, pressed by a
rigid paraboloid with Coulomb's friction in many increments; the law holds, exactly,

    nodes       at each node (as in langer)
    averages    for each node in the mean over its surroundings, weighted with its shape function (mortar)
    centres     at the centre of each facet
    Gauss       at two Gauss points of each facet, with a compliance (penalty): there are more of them than nodes
    glued       at the nodes of a region that does not grow and is glued from the beginning: no law, no history

and what is compared is the part that tangential reactions have in the force on a curved indenter, sum r_t x / R. Prints a table."""
import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg

RADIUS, DEPTH, HEIGHT, WIDTH = 2.5, 0.5, 4.0, 12.0  # mm
NU, FRICTION, INCREMENTS = 0.495, 0.34, 40
CONTACT, CANDIDATES = 1.2, 2.08  # radius of the contact, and of where candidates are [mm]
SOFT = 1e-3  # compliance of Gauss points, in the mean of the body's own
LENGTHS = (0.24, 0.17, 0.12, 0.085, 0.06, 0.042, 0.03)  # mm


def grid(h):
    """radii, even under the indenter, and depths"""
    r, step = list(np.arange(int(np.ceil(CANDIDATES / h)) + 1) * h), h
    n = len(r) - 1
    while r[-1] < WIDTH:
        step *= 1 + 0.8 * h
        r.append(r[-1] + step)
    r = np.array(r)
    r[n:] = r[n] + (r[n:] - r[n]) * (WIDTH - r[n]) / (r[-1] - r[n])
    y, step = [0.0], h
    while y[-1] < HEIGHT:
        y.append(y[-1] + step)
        step *= 1 + 0.8 * h
    return r, -np.array(y) * HEIGHT / y[-1]


def compliance(r, y, n):
    """of the first n nodes of the surface, radial and axial in turn; Young's modulus 1"""
    nr, ny = len(r), len(y)
    mu, bulk = 0.5 / (1 + NU), 1 / (3 * (1 - 2 * NU))
    i, j = np.meshgrid(np.arange(nr - 1), np.arange(ny - 1))
    i, j = i.ravel(), j.ravel()
    cells = np.stack([(j + 1) * nr + i, (j + 1) * nr + i + 1, j * nr + i + 1, j * nr + i], 1)
    hr, hy = r[i + 1] - r[i], y[j] - y[j + 1]
    sx, sy = np.array([-1, 1, 1, -1]), np.array([-1, -1, 1, 1])
    points = []
    for gx in (-(3**-0.5), 3**-0.5):
        for gy in (-(3**-0.5), 3**-0.5):
            radius = r[i] * (1 - gx) / 2 + r[i + 1] * (1 + gx) / 2
            B = np.zeros((len(i), 4, 8))  # e_r, e_y, e_phi, gamma
            B[:, 0, 0::2] = B[:, 3, 1::2] = sx * (1 + sy * gy) / 2 / hr[:, None]
            B[:, 1, 1::2] = B[:, 3, 0::2] = sy * (1 + sx * gx) / 2 / hy[:, None]
            B[:, 2, 0::2] = (1 + sx * gx) * (1 + sy * gy) / 4 / radius[:, None]
            points.append((B, 2 * np.pi * radius * hr * hy / 4))
    volume = sum(w for _, w in points)
    mean = sum(B[:, :3].sum(1) * w[:, None] for B, w in points) / volume[:, None]
    K = np.einsum("ci,cj,c->cij", mean, mean, bulk * volume)
    for B, w in points:
        trace, deviator = B[:, :3].sum(1), B.copy()
        deviator[:, :3] -= trace[:, None] / 3
        K += np.einsum("cki,k,ckj,c->cij", deviator, mu * np.array([2, 2, 2, 1]), deviator, w)
    dofs = np.stack([2 * cells, 2 * cells + 1], 2).reshape(-1, 8)
    free = np.ones(2 * nr * ny, bool)
    free[2 * (ny - 1) * nr :] = free[2 * np.arange(ny) * nr] = False
    rows, columns = np.repeat(dofs, 8, 1).ravel(), np.tile(dofs, (1, 8)).ravel()
    full = sparse.coo_matrix((K.ravel(), (rows, columns)), shape=(len(free),) * 2).tocsc()
    factor = sparse.linalg.splu(full[free][:, free])
    row = np.cumsum(free) - 1
    C = np.zeros((2 * n, 2 * n))
    for d in np.flatnonzero(free[: 2 * n]):
        force = np.zeros(row[-1] + 1)
        force[row[d]] = 1
        C[:, d] = np.where(free[: 2 * n], factor.solve(force)[row[: 2 * n]], 0)
    return C


def points_of(kind, r):
    """shape functions of the nodes at the points of the law, and gaps there"""
    n = len(r)
    gap = lambda x: x**2 / (2 * RADIUS)
    if kind == "nodes":
        return np.eye(n), gap(r)
    at = {"averages": np.polynomial.legendre.leggauss(4), "centres": ([0.0], [1.0]), "Gauss": ([-(3**-0.5), 3**-0.5], [1.0, 1.0])}[kind]
    N, g, weights = [], [], []
    for e in range(n - 1):
        for q, w in zip(*at):
            row = np.zeros(n)
            row[e], row[e + 1] = (1 - q) / 2, (1 + q) / 2
            N.append(row), g.append(gap(row @ r)), weights.append(w * (r[e + 1] - r[e]) * (row @ r))
    N, g, weights = np.array(N), np.array(g), np.array(weights)
    if kind != "averages":
        return N, g
    area = N.T @ weights
    return (N.T * weights @ N / area[:, None])[:-1], (N.T @ (weights * g) / area)[:-1]


def slope_part(tangential, radii):
    return float(tangential @ radii) / RADIUS


def pressed(kind, r, C):
    N, gap0 = points_of(kind, r)
    m = len(N)
    P = np.zeros((2 * m, 2 * len(r)))
    P[0::2, 0::2] = P[1::2, 1::2] = N
    W = P @ C @ P.T
    if kind == "Gauss":
        W += np.eye(2 * m) * SOFT * np.trace(W) / (2 * m)
    slides = np.diag(W)[0::2] > 1e-12 * W.max()  # not on the axis
    scale = 0.5 / np.where(np.diag(W) > 1e-12 * W.max(), np.diag(W), W.max())
    rt, rn, before, distance = np.zeros(m), np.zeros(m), np.zeros(m), gap0.copy()
    was_closed = np.zeros(m, bool)
    for step in range(1, INCREMENTS + 1):
        depth, moved = DEPTH * step / INCREMENTS, DEPTH / INCREMENTS
        start = before.copy()
        for _ in range(60):  # what touches in this increment slips from where it does
            last = None
            for _ in range(200):  # who is open, sticks and slips
                force = np.zeros(2 * m)
                force[0::2], force[1::2] = rt, -rn
                u = W @ force
                trial_n = rn - scale[1::2] * (gap0 - depth - u[1::2])
                trial_t = rt - scale[0::2] * (u[0::2] - start)
                closed = trial_n > 0
                stick = closed & slides & (np.abs(trial_t) <= FRICTION * trial_n)
                slip, sense = closed & slides & ~stick, np.sign(trial_t)
                now = (closed.tobytes(), stick.tobytes(), sense[slip].tobytes())
                if now == last:
                    break
                last = now
                c, s = np.flatnonzero(closed), np.flatnonzero(stick)
                T = np.zeros((2 * m, len(c) + len(s)))
                T[2 * c + 1, np.arange(len(c))] = -1
                T[2 * c, np.arange(len(c))] = np.where(slip[c], FRICTION * sense[c], 0)
                T[2 * s, len(c) + np.arange(len(s))] = 1
                solved = T @ np.linalg.solve(W[np.r_[2 * c + 1, 2 * s]] @ T, np.r_[gap0[c] - depth, start[s]])
                rt, rn = solved[0::2], -solved[1::2]
            share = np.clip(distance / moved, 0, 1)
            touched = np.where(closed & ~was_closed, before + share * (u[0::2] - before), before)
            if np.max(np.abs(touched - start)) < 1e-10:
                break
            start = touched
        was_closed, before, distance = closed, u[0::2].copy(), gap0 - depth - u[1::2]
    return slope_part(rt, N @ r)


def glued(r, C):
    inside = np.flatnonzero(r <= CONTACT + 1e-9)
    rows = np.r_[2 * inside + 1, 2 * inside[1:]]
    down = -(DEPTH - r[inside] ** 2 / (2 * RADIUS))
    forces = np.linalg.solve(C[np.ix_(rows, rows)], np.r_[down, np.zeros(len(inside) - 1)])
    return slope_part(forces[len(inside) :], r[inside[1:]])


def main():
    kinds = ("nodes", "averages", "centres", "Gauss")
    values = {kind: [] for kind in kinds + ("glued",)}
    for h in LENGTHS:
        r, y = grid(h)
        n = int(np.sum(r <= CANDIDATES + 1e-9))
        C = compliance(r, y, n)
        for kind in kinds:
            values[kind].append(pressed(kind, r[:n], C))
        # its edge at a node on every mesh
        stretched = r * CONTACT / r[int(round(CONTACT / h))]
        values["glued"].append(glued(stretched[:n], compliance(stretched, y, n)))
    # of first order in the length
    limit = {k: v[-1] - (v[-2] - v[-1]) * LENGTHS[-1] / (LENGTHS[-2] - LENGTHS[-1]) for k, v in values.items()}
    print("| cells, contact radii | at nodes | averages | centres of facets | Gauss points | glued region |\n| --- | --- | --- | --- | --- | --- |")
    for i, h in enumerate(LENGTHS):
        off = [f"{100 * (v[i] / limit[k if k == 'glued' else 'nodes'] - 1):+.0f}" for k, v in values.items()]
        print(f"| {h / CONTACT:.3f} | " + " | ".join(off) + " |")


main()
