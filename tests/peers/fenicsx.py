"""FEniCSx on a deck of langer-post --export: python3 fenicsx.py deck.inp [law] [d] [penalty] [increments]
Q2 displacements and discontinuous linear pressure (mixed), contact by a penalty at the quadrature points against the exact sphere,
friction regularised; Newton with step halving and MUMPS, increments start from an extrapolation. Energies are given, stress and
tangents derived by UFL."""
import sys

import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI
from petsc4py import PETSc

import scene as peers
from fenicsx_common import Newton, isochoric_energy

deck = peers.read_deck(sys.argv[1])
law = peers.LAWS[sys.argv[2] if len(sys.argv) > 2 else "isotropic"]
d = float(sys.argv[3]) if len(sys.argv) > 3 else 1e-6
penalty = float(sys.argv[4]) if len(sys.argv) > 4 else 1e3  # MPa/mm
increments = int(sys.argv[5]) if len(sys.argv) > 5 else 10

cells = deck.cells[:, peers.TENSOR_ORDER]
body = mesh.create_mesh(MPI.COMM_WORLD, cells, deck.nodes, ufl.Mesh(ufl.VectorElement("Lagrange", ufl.hexahedron, 1)))
d, penalty = (fem.Constant(body, PETSc.ScalarType(x)) for x in (d, penalty))  # no new compilation for other values
element = ufl.MixedElement(ufl.VectorElement("Lagrange", ufl.hexahedron, 2), ufl.FiniteElement("DPC", ufl.hexahedron, 1))
space = fem.FunctionSpace(body, element)
top = deck.nodes[deck.sets["contact"], 1].max()
reach = np.linalg.norm(deck.nodes[deck.sets["contact"]] - deck.centre * (1, 0, 1), axis=1).max()


def near_sphere(x):
    return np.isclose(x[1], top) & (np.hypot(x[0] - deck.centre[0], x[2] - deck.centre[2]) < reach)


facets = mesh.locate_entities_boundary(body, 2, near_sphere)
tags = mesh.meshtags(body, 2, np.sort(facets), np.ones(len(facets), dtype=np.int32))
degree = {"quadrature_degree": 4}
dx, ds = ufl.Measure("dx", body, metadata=degree), ufl.Measure("ds", body, subdomain_data=tags, metadata=degree)(1)

conditions = []
for name, axis in deck.held:
    planes = deck.nodes[deck.sets[name]]
    across = int(np.argmin(planes.max(axis=0) - planes.min(axis=0)))  # every held set is a plane
    part = space.sub(0).sub(axis)
    dofs = fem.locate_dofs_geometrical((part, part.collapse()[0]), lambda x: np.isclose(x[across], planes[0, across]))
    zero = fem.Function(part.collapse()[0])
    conditions.append(fem.dirichletbc(zero, dofs, part))

w, old = fem.Function(space), fem.Function(space)
u, p = ufl.split(w)
F = ufl.Identity(3) + ufl.grad(u)
J = ufl.det(F)
energy = isochoric_energy(F, law) + p * (J - 1) - d / 4 * p**2

moved = fem.Constant(body, PETSc.ScalarType((0.0, 0.0, 0.0)))
moved_before = fem.Constant(body, PETSc.ScalarType((0.0, 0.0, 0.0)))
from_centre = ufl.SpatialCoordinate(body) + u - ufl.as_vector(deck.centre) - moved
distance = ufl.sqrt(ufl.inner(from_centre, from_centre))
normal = from_centre / distance
inside = ufl.conditional(ufl.lt(distance, deck.radius), deck.radius - distance, 0)
pressure = penalty * inside
test = ufl.TestFunction(space)
residual = ufl.derivative(energy * dx + penalty / 2 * inside**2 * ds, w, test)
if deck.friction > 0:
    slip = u - ufl.split(old)[0] - (moved - moved_before)
    slip = slip - ufl.inner(slip, normal) * normal
    little = 1e-3  # mm: below it stick is a spring
    residual += deck.friction * pressure * ufl.inner(slip, ufl.split(test)[0]) / ufl.sqrt(ufl.inner(slip, slip) + little**2) * ds

newton = Newton(residual, w, conditions, lifted=False)
earlier = [w.x.array.copy(), w.x.array.copy(), 0.0, 0.0]  # the last two states and their t


def solve(t):
    moved.value[:] = t * deck.to
    before, last, t_before, t_last = earlier
    if t_last > t_before:
        w.x.array[:] = last + (t - t_last) / (t_last - t_before) * (last - before)
    if not newton.solve():
        return False
    earlier[:] = [last, w.x.array.copy(), t_last, t]
    return True


def keep():
    old.x.array[:] = w.x.array
    moved_before.value[:] = moved.value


def back():
    w.x.array[:] = old.x.array
    moved.value[:] = moved_before.value


peers.along_path(solve, keep, back, increments)
force = -deck.share * fem.assemble_scalar(fem.form(pressure * normal[1] * ds))
if deck.friction > 0:  # the body slides up along the sphere and takes it with it
    drag = deck.friction * pressure * slip[1] / ufl.sqrt(ufl.inner(slip, slip) + little**2)
    force += deck.share * fem.assemble_scalar(fem.form(drag * ds))
found = w.sub(0).collapse()
places = found.function_space.tabulate_dof_coordinates()
on_top = near_sphere(places.T)
x = places[on_top] + found.x.array.reshape(-1, 3)[on_top]
unknowns = space.dofmap.index_map.size_global * space.dofmap.index_map_bs
peers.say(force=abs(force), penetration=peers.penetration(deck, x, 1.0), unknowns=unknowns)
