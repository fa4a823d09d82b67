"""Boxes without contact, for Langer and FEniCSx: a clamped strip with fibres at 45 degrees, pulled; suction through a square hole; the
strip with viscous branches, pulled and held. mm, N, MPa, s."""
import numpy as np

import scene

LAW = dict(scene.LAWS["positive"], alpha=45)
STRIP = (30.0, 1.0, 10.0)


def plane(axis, value):
    return lambda x: np.isclose(x[axis], value)


CLAMPED = [(plane(0, 0.0), axis, 0.0) for axis in range(3)] + [(plane(0, 30.0), 1, 0.0), (plane(0, 30.0), 2, 0.0)]
STRIP_SCENE = dict(size=STRIP, law=LAW, held=CLAMPED + [(plane(0, 30.0), 0, 6.0)], pulled=plane(0, 30.0), increments=4)
SOFT = dict(a=(0.012, 0.03, 0.01))


def ring(x):
    """what the plate holds: the top but for the hole"""
    return np.isclose(x[1], 4.0) & ((x[0] > 2 - 1e-6) | (x[2] > 2 - 1e-6))


def hole(x):
    return np.isclose(x[1], 4.0) & (x[0] < 2 + 1e-6) & (x[2] < 2 + 1e-6)


SCENES = {
    "strip": STRIP_SCENE,
    # branches: gamma, tau; seconds of ramp and hold
    "hold": dict(STRIP_SCENE, branches=[(0.5, 1.0), (0.3, 10.0)], seconds=(1.0, 10.0), increments=16),
    # a quarter of 12 x 4 x 12 mm
    "suction": dict(size=(6.0, 4.0, 6.0), law=SOFT, pressure=-0.03, pressed=hole, apex=(0.0, 4.0, 0.0), increments=5,
                    held=[(plane(1, 0.0), axis, 0.0) for axis in range(3)] + [(ring, axis, 0.0) for axis in range(3)] +
                         [(plane(0, 0.0), 0, 0.0), (plane(2, 0.0), 2, 0.0)]),
}


def divisions(name, edge):
    return [max(1, round(length / edge)) for length in SCENES[name]["size"]]
