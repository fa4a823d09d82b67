"""Is a .feb file well formed, is every node, material, set, surface, curve and rigid body there that it names, and does it end where
the path does, with the tolerances and the contact that were found to give Langer's forces?"""
import sys
import xml.etree.ElementTree as tree

root = tree.parse(sys.argv[1]).getroot()
assert root.tag == "febio_spec" and root.get("version") == "4.0"
mesh = root.find("Mesh")
nodes = {n.get("id") for n in mesh.iter("node")}
assert len(nodes) == len(list(mesh.iter("node"))), "a node number twice"
per_cell = {"hex8": 8, "hex27": 27}
cells = []
for part in mesh.findall("Elements"):
    for cell in part:
        cells.append(cell.get("id"))
        corners = cell.text.split(",")
        assert len(set(corners)) == per_cell[part.get("type")], cell.get("id")
        assert set(corners) <= nodes
assert len(set(cells)) == len(cells), "a cell number twice"
for surface in mesh.findall("Surface"):
    for facet in surface:
        corners = facet.text.split(",")
        assert len(set(corners)) == int(facet.tag[4:]) and set(corners) <= nodes
for chosen in mesh.findall("NodeSet"):
    assert set(chosen.text.split(",")) <= nodes, chosen.get("name")


def named(path):
    return {e.get("name") for e in root.findall(path)}


materials, sets, surfaces = named("Material/material"), named("Mesh/NodeSet"), named("Mesh/Surface")
assert {d.get("name") for d in root.find("MeshDomains")} == named("Mesh/Elements")
assert {d.get("mat") for d in root.find("MeshDomains")} == materials
for bc in root.findall("Boundary/bc"):
    assert bc.get("node_set") in sets
for pair in root.findall("Mesh/SurfacePair"):
    assert pair.find("primary").text in surfaces and pair.find("secondary").text in surfaces
assert {c.get("surface_pair") for c in root.findall("Contact/contact")} == named("Mesh/SurfacePair")
for rigid in root.findall("Rigid/rigid_bc"):
    assert rigid.find("rb").text in materials
curves = {c.get("id") for c in root.findall("LoadData/load_controller")}
assert {v.get("lc") for v in root.iter("value")} <= curves


def number(path):
    return float(root.find(path).text)


assert abs(number("Control/time_steps") * number("Control/step_size") - 1) < 1e-12, "the path does not end at 1"
assert number("Control/solver/dtol") <= 1e-6 and number("Control/solver/etol") <= 1e-9
stops = root.find("Control/time_stepper/dtmax").get("lc")
points = {c.get("id"): [tuple(map(float, p.text.split(","))) for p in c.iter("pt")] for c in root.iter("load_controller")}
must = [t for t, _ in points[stops]]
assert must == sorted(set(must)) and must[0] == 0 and must[-1] == 1
for curve in points.values():  # where an indenter turns, an increment ends
    assert {t for t, _ in curve} <= set(must), (curve, must)
for contact in root.findall("Contact/contact"):
    assert contact.find("laugon").text == "PENALTY" and number("Contact/contact/penalty") == 100
    assert contact.find("symmetric_stiffness").text == "0"
    assert root.find("Control/solver/symmetric_stiffness").text == "non-symmetric"
moved = {bc.get("node_set") for bc in root.findall("Boundary/bc") if bc.get("type") == "prescribed displacement"}
assert moved == {d.get("node_set") for d in root.findall("Output/logfile/node_data")}, "reactions of what is moved"
logged = {d.text for d in root.findall("Output/logfile/rigid_body_data")}
assert logged == {m.get("id") for m in root.iter("material") if m.get("type") == "rigid body"}, "forces of the indenters"
for material in root.iter("material"):  # what FEBio's own ranges refuse
    for tag, low in (("ksi", 0), ("k1", 0), ("c", 0), ("k2", 0), ("alpha", 0)):
        assert all(float(v.text) >= low for v in material.iter(tag)), (material.get("name"), tag)
    assert material.get("type") != "Arruda-Boyce"
print(f"{len(nodes)} nodes, {len(cells)} cells, {len(materials)} materials, {len(sets)} node sets, {len(surfaces)} surfaces")
