"""Is a .feb file well formed, and is every node, material, set, surface, curve and rigid body there that it names?"""
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
print(f"{len(nodes)} nodes, {len(cells)} cells, {len(materials)} materials, {len(sets)} node sets, {len(surfaces)} surfaces")
