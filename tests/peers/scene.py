"""A deck of CalculiX that langer-post --export wrote, read by the other peers, so that all solve the same scene on the same cells."""
import json
import re
import sys
from types import SimpleNamespace

import numpy as np

# laws by the name of the scene; MPa, -, degrees. The decks of isotropic scenes hold the same numbers.
LAWS = {
    "isotropic": dict(a=(0.269, 0.376, 0.415)),
    "positive": dict(a=(0.269, 0.376, 0.415), c1=0.317, c2=0.319, alpha=30),
    "table1": dict(a=(0.269, 0.376, 0.415), c1=-0.317, c2=0.319, alpha=60),
}
TENSOR_ORDER = [0, 1, 3, 2, 4, 5, 7, 6]  # of a hexahedron's corners, as GetFEM and DOLFINx count


def read_deck(path):
    """nodes (n, 3), cells (m, 8) in VTK order, sets: name -> nodes, held: [(set, axis)], sphere, share"""
    text = open(path).read()
    sphere = re.search(r'radius (\S+), centre \((.*?)\), ends moved by \((.*?)\), friction (\S+)', text)
    share = re.search(r"forces here are 1/(\S+) of", text)
    ids, places, cells, sets, held, card, rest = [], [], [], {}, [], "", []
    for line in text.splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            card = line.upper().replace(" ", "")
            name = line.split("=")[-1].strip()
            if card.startswith("*STEP"):
                break
            continue
        numbers = [x.strip() for x in line.split(",") if x.strip()]
        if card.startswith("*NODE,NSET=BODY"):
            ids.append(int(numbers[0])), places.append([float(x) for x in numbers[1:]])
        elif card.startswith("*ELEMENT") and "ELSET=CELLS" in card:
            rest += [int(x) for x in numbers]
            if len(rest) == (9 if "C3D8" in card else 21):
                cells.append(rest[1:9]), rest.clear()
        elif card.startswith("*NSET"):
            sets.setdefault(name, []).extend(int(x) for x in numbers)
        elif card == "*BOUNDARY":
            held.append((numbers[0], int(numbers[1]) - 1))
    used = sorted({n for c in cells for n in c})
    number = {n: i for i, n in enumerate(used)}
    place = dict(zip(ids, places))
    return SimpleNamespace(
        nodes=np.array([place[n] for n in used]),
        cells=np.array([[number[n] for n in c] for c in cells]),
        sets={k: np.array([number[n] for n in v if n in number]) for k, v in sets.items()},
        held=held,
        radius=float(sphere[1]),
        centre=np.array([float(x) for x in sphere[2].split(",")]),
        to=np.array([float(x) for x in sphere[3].split(",")]),
        friction=float(sphere[4]),
        share=float(share[1]) if share else 1.0,
    )


def penetration(scene, x, t):
    """how far the sphere is in, at most over the places x of nodes [mm]"""
    return float(max(0.0, (scene.radius - np.linalg.norm(x - scene.centre - t * scene.to, axis=1)).max()))


def along_path(solve, keep, back, increments):
    """Increments from 0 to 1, halved where solve(t) says no; back() restores what keep() kept. Ends the program where none is left."""
    t, step = 0.0, 1.0 / increments
    while t < 1 - 1e-12:
        keep()
        if solve(min(1.0, t + step)):
            t = min(1.0, t + step)
            step = min(2 * step, 1.0 / increments)
            continue
        back()
        step /= 2
        if step < 1e-3:
            say(words=f"stalls at t = {t:.3g}: no convergence in increments of {step:.1e}")
            sys.exit(4)


def say(**what):
    print(json.dumps(what), flush=True)
