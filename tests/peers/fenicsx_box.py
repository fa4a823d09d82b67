"""FEniCSx on a box without contact: python3 fenicsx_box.py strip|suction|hold edge [increments]
Q2 displacements and discontinuous linear pressure (mixed) as in fenicsx.py; Newton with step halving and MUMPS, increments start from
an extrapolation. The scenes are those of box_scenes.py."""
import sys

import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI
from petsc4py import PETSc

import box_scenes
import scene as peers
from fenicsx_common import FAST, Newton, isochoric_energy

name, edge = sys.argv[1], float(sys.argv[2])
scene = box_scenes.SCENES[name]
increments = int(sys.argv[3]) if len(sys.argv) > 3 else scene["increments"]

size, divisions = scene["size"], box_scenes.divisions(name, edge)
body = mesh.create_box(MPI.COMM_WORLD, [np.zeros(3), np.array(size)], divisions, mesh.CellType.hexahedron)
element = ufl.MixedElement(ufl.VectorElement("Lagrange", ufl.hexahedron, 2), ufl.FiniteElement("DPC", ufl.hexahedron, 1))
space = fem.FunctionSpace(body, element)
d = fem.Constant(body, PETSc.ScalarType(1e-6))
degree = {"quadrature_degree": 4}
facets = mesh.locate_entities_boundary(body, 2, scene.get("pressed", lambda x: np.isclose(x[0], -1)))
tags = mesh.meshtags(body, 2, np.sort(facets), np.ones(len(facets), dtype=np.int32))
dx, ds = ufl.Measure("dx", body, metadata=degree), ufl.Measure("ds", body, subdomain_data=tags, metadata=degree)(1)

conditions, prescribed = [], []
for where, axis, value in scene["held"]:
    part = space.sub(0).sub(axis)
    values = fem.Function(part.collapse()[0])
    dofs = fem.locate_dofs_geometrical((part, part.collapse()[0]), where)
    conditions.append(fem.dirichletbc(values, dofs, part))
    prescribed.append((values, value))

w, test = fem.Function(space), ufl.TestFunction(space)
u, p = ufl.split(w)
F = ufl.Identity(3) + ufl.grad(u)
J = ufl.det(F)


residual = ufl.derivative((isochoric_energy(F, scene["law"]) + p * (J - 1) - d / 4 * p**2) * dx, w, test)
pressure = fem.Constant(body, PETSc.ScalarType(0.0))
if "pressure" in scene:  # follows the surface
    normal = ufl.FacetNormal(body)
    residual += pressure * J * ufl.inner(ufl.dot(ufl.inv(F).T, normal), ufl.split(test)[0]) * ds

# viscous branches: overstresses at the quadrature points,
#   Q' + Q / tau = gamma S',   Q(n+1) = keep Q(n) + follow (S(n+1) - S(n)),   S = F^-1 dW/dF
branches, kept = scene.get("branches", []), []
if branches:
    points = ufl.TensorElement("Quadrature", ufl.hexahedron, degree=4, quad_scheme="default", shape=(3, 3))
    at_points = fem.FunctionSpace(body, points)
    F_of = ufl.variable(F)
    S = ufl.dot(ufl.inv(F), ufl.diff(isochoric_energy(F_of, scene["law"]), F_of))
    S_old = fem.Function(at_points)
    overstress = 0
    for gamma, tau in branches:
        Q_old = fem.Function(at_points)
        keep_share, follow = (fem.Constant(body, PETSc.ScalarType(0.0)) for _ in range(2))
        Q = keep_share * Q_old + follow * (S - S_old)
        kept.append((Q_old, Q, keep_share, follow, gamma, tau))
        overstress += Q
    residual += ufl.inner(ufl.dot(F, overstress), ufl.grad(ufl.split(test)[0])) * dx
    import basix

    places, _ = basix.make_quadrature(basix.CellType.hexahedron, 4)
    S_now = fem.Expression(S, places, jit_params=FAST)
    Q_now = [fem.Expression(Q, places, jit_params=FAST) for _, Q, *_ in kept]
    all_cells = np.arange(body.topology.index_map(3).size_local, dtype=np.int32)
    of_cell = at_points.dofmap.list.array.reshape(len(all_cells), -1)
    new = [fem.Function(at_points) for _ in kept]


def put(function, expression):
    """the values of an expression at the quadrature points"""
    function.x.array.reshape(-1, 9)[of_cell] = expression.eval(all_cells).reshape(*of_cell.shape, 9)


newton = Newton(residual, w, conditions, lifted=True)
earlier = [w.x.array.copy(), w.x.array.copy(), 0.0, 0.0]  # the last two states and their t


def seconds(t):
    """of the path at t: a ramp for the first half of the increments, the hold for the rest"""
    ramp, hold = scene.get("seconds", (1, 0))
    return ramp * min(t / 0.5, 1) + hold * max(0, t / 0.5 - 1) if hold else ramp * t


def load(t):
    return min(t / 0.5, 1) if "seconds" in scene else t


reaction = [0.0]


def reaction_of_pulled_end():
    """what the residual without conditions does there"""
    part = space.sub(0).sub(0)
    return newton.assembled().array[fem.locate_dofs_geometrical((part, part.collapse()[0]), scene["pulled"])[0]].sum()


def solve(t):
    for values, value in prescribed:
        values.x.array[:] = load(t) * value
    pressure.value = load(t) * scene.get("pressure", 0)
    before, last, t_before, t_last = earlier
    for Q_old, _, keep_share, follow, gamma, tau in kept:
        x = (seconds(t) - seconds(t_last)) / tau
        keep_share.value, follow.value = np.exp(-x), gamma * -np.expm1(-x) / x
    if t_last > t_before and load(t) > load(t_last):
        w.x.array[:] = last + (load(t) - load(t_last)) / (load(t_last) - load(t_before)) * (last - before)
    if not newton.solve():
        return False
    if "pressure" not in scene:
        reaction[0] = reaction_of_pulled_end()  # before the branches go on
    if kept:
        for values, expression in zip(new, Q_now):
            put(values, expression)
        put(S_old, S_now)
        for (Q_old, *_), values in zip(kept, new):
            Q_old.x.array[:] = values.x.array
    earlier[:] = [last, w.x.array.copy(), t_last, t]
    return True


def keep():
    pass


def back():
    w.x.array[:] = earlier[1]


peers.along_path(solve, keep, back, increments)
unknowns = space.dofmap.index_map.size_global * space.dofmap.index_map_bs
if "pressure" in scene:
    found = w.sub(0).collapse()
    places = found.function_space.tabulate_dof_coordinates()
    apex = np.linalg.norm(places - np.array(scene["apex"]), axis=1).argmin()
    value = found.x.array.reshape(-1, 3)[apex, 1]
else:
    value = reaction[0]
peers.say(force=float(abs(value)), penetration=0.0, unknowns=unknowns)
