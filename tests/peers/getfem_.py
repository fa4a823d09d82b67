"""GetFEM on a deck of langer-post --export: python3 getfem_.py deck.inp [law] [d] [element] [penalty] [increments]
element q2 (Q2 displacements, continuous Q1 pressure) or q1 (Q1, one pressure in a cell). Contact at the quadrature points against the
exact sphere: by a penalty [MPa/mm], or with "augmented" in its place by multipliers (augmented Lagrangian). Energies are given in
GetFEM's language, which derives stress and tangents; Newton with MUMPS, increments start from an extrapolation."""
import sys

import getfem as gf
import numpy as np

import scene as peers

gf.util_trace_level(0), gf.util_warning_level(0)
deck = peers.read_deck(sys.argv[1])
law = peers.LAWS[sys.argv[2] if len(sys.argv) > 2 else "isotropic"]
d = float(sys.argv[3]) if len(sys.argv) > 3 else 1e-6
quadratic = (sys.argv[4] if len(sys.argv) > 4 else "q2") == "q2"
contact = sys.argv[5] if len(sys.argv) > 5 else "1e3"
increments = int(sys.argv[6]) if len(sys.argv) > 6 else 10

body = gf.Mesh("empty", 3)
corners = deck.nodes[deck.cells[:, peers.TENSOR_ORDER]]  # cells, 8, 3
body.add_convex(gf.GeoTrans("GT_QK(3,1)"), np.transpose(corners, (2, 1, 0)))
points = body.pts()
BOTTOM, TOP = 1, 2
planes = {}  # region -> axis


def points_at(axis, value):
    return body.pid_from_coords(points[:, np.isclose(points[axis], value)])


for name, axis in deck.held:
    places = deck.nodes[deck.sets[name]]
    across = int(np.argmin(places.max(axis=0) - places.min(axis=0)))
    number = BOTTOM if name == "bottom" else 10 + across
    body.set_region(number, body.faces_from_pid(points_at(across, places[0, across])))
    if number != BOTTOM:
        planes[number] = axis
top = deck.nodes[deck.sets["contact"], 1].max()
reach = np.linalg.norm(deck.nodes[deck.sets["contact"]] - deck.centre * (1, 0, 1), axis=1).max()
near = np.isclose(points[1], top) & (np.hypot(points[0] - deck.centre[0], points[2] - deck.centre[2]) < reach + 1e-9)
body.set_region(TOP, body.faces_from_pid(body.pid_from_coords(points[:, near])))

order = 2 if quadratic else 1
mf_u = gf.MeshFem(body, 3)
mf_u.set_fem(gf.Fem(f"FEM_QK(3,{order})"))
mf_p = gf.MeshFem(body, 1)
mf_p.set_fem(gf.Fem("FEM_QK(3,1)" if quadratic else "FEM_QK_DISCONTINUOUS(3,0)"))
gauss = gf.MeshIm(body, gf.Integ("IM_GAUSS_PARALLELEPIPED(3,%d)" % (4 if quadratic else 2)))
on_face = gf.MeshIm(body, gf.Integ("IM_GAUSS_PARALLELEPIPED(3,%d)" % (4 if quadratic else 2)))

model = gf.Model("real")
model.add_fem_variable("u", mf_u)
model.add_fem_variable("p", mf_p)
for name, value in [("a1", law["a"][0]), ("a2", law["a"][1]), ("a3", law["a"][2]), ("d", d), ("R", deck.radius)]:
    model.add_initialized_data(name, [value])
model.add_initialized_data("centre", deck.centre)
model.add_macro("F", "Id(3)+Grad_u")
model.add_macro("K", "Norm_sqr(F)*pow(Det(F),-2/3)-3")
energy = "a1*K+a2*sqr(K)+a3*K*sqr(K)+p*(Det(F)-1)-d/4*sqr(p)"
if "c1" in law:
    alpha = np.radians(law["alpha"])
    model.add_initialized_data("fibre", [np.cos(alpha), 0, np.sin(alpha)])
    model.add_initialized_data("c1", [law["c1"]]), model.add_initialized_data("c2", [law["c2"]])
    model.add_macro("I4", "Norm_sqr(F*fibre)*pow(Det(F),-2/3)-1")
    # its first variation: pos_part is not derived twice
    model.add_nonlinear_term(gauss, "c1*pos_part(I4)*exp(c2*sqr(pos_part(I4)))*Diff(I4,u,Test_u)")
model.add_nonlinear_term(gauss, energy)
model.add_macro("gap", "Norm(X+u-centre)-R")
if contact == "augmented":
    mf_l = gf.MeshFem(body, 1)
    mf_l.set_fem(gf.Fem(f"FEM_QK(3,{order})"))
    model.add_filtered_fem_variable("l", mf_l, TOP)
    model.add_initialized_data("r", [10.0])
    model.add_nonlinear_term(on_face, "1/(2*r)*(sqr(neg_part(l+r*gap))-sqr(l))", TOP)
    pressure = "neg_part(l+r*gap)"
else:
    model.add_initialized_data("r", [float(contact)])
    model.add_nonlinear_term(on_face, "r/2*sqr(neg_part(gap))", TOP)
    pressure = "r*neg_part(gap)"
if deck.friction > 0:
    model.add_fem_data("u_before", mf_u)
    model.add_initialized_data("moved", [0, 0, 0]), model.add_initialized_data("little", [1e-3])
    model.add_initialized_data("mu", [deck.friction])
    model.add_macro("away", "Normalized(X+u-centre)")
    model.add_macro("slip", "(u-u_before-moved)-((u-u_before-moved).away)*away")
    model.add_nonlinear_term(on_face, f"mu*{pressure}*(slip.Test_u)/sqrt(Norm_sqr(slip)+sqr(little))", TOP)
model.add_Dirichlet_condition_with_simplification("u", BOTTOM)
for number, axis in planes.items():
    only = np.zeros((3, 3))
    only[axis, axis] = 1
    model.add_initialized_data(f"H{number}", only.flatten())
    model.add_initialized_data(f"zero{number}", [0, 0, 0])
    model.add_generalized_Dirichlet_condition_with_penalization(gauss, "u", 1e7, number, f"zero{number}", f"H{number}")

state = [np.zeros(model.nbdof()), np.zeros(model.nbdof()), 0.0, 0.0]


def solve(t):
    before, last, t_before, t_last = state
    model.set_variable("centre", deck.centre + t * deck.to)
    if deck.friction > 0:
        model.set_variable("moved", (t - t_last) * deck.to)
        model.set_variable("u_before", np.array(u_of(last)))
    guess = last + (t - t_last) / (t_last - t_before) * (last - before) if t_last > t_before else last
    model.to_variables(guess)
    try:
        iterations, ok = model.solve("max_res", 1e-8, "max_iter", 30, "lsolver", "mumps", "lsearch", "simplest", "alpha min", 0.05)[:2]
    except RuntimeError:
        return False
    found = model.from_variables()
    if not ok or not np.isfinite(found).all():
        return False
    state[:] = [last, found, t_last, t]
    return True


def u_of(values):
    model.to_variables(values)
    return model.variable("u")


peers.along_path(solve, lambda: None, lambda: None, increments)
force = gf.asm_generic(on_face, 0, f"{pressure}*(Normalized(X+u-centre)(2))", TOP, model)
if deck.friction > 0:
    force -= gf.asm_generic(on_face, 0, f"mu*{pressure}*slip(2)/sqrt(Norm_sqr(slip)+sqr(little))", TOP, model)
places = mf_u.basic_dof_nodes()[:, ::3].T
on_top = np.isclose(places[:, 1], top) & (np.hypot(places[:, 0] - deck.centre[0], places[:, 2] - deck.centre[2]) < reach + 1e-9)
x = places[on_top] + model.variable("u").reshape(-1, 3)[on_top]
peers.say(force=abs(deck.share * float(force)), penetration=peers.penetration(deck, x, 1.0), unknowns=int(model.nbdof()))
