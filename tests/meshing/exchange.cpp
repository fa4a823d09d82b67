// Meshes to and from Gmsh, Abaqus and CalculiX.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/base/error.hpp"
#include "core/base/traps.hpp"
#include "mechanics/element/surface.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/quality.hpp"
#include "mechanics/mesh/select.hpp"
#include "meshing/exchange.hpp"
#include "meshing/gmsh/gmsh_session.hpp"
#include "support/block.hpp"
#include "support/near.hpp"

using namespace langer;

namespace exchange_tests {

namespace {

std::string folder() {
  const auto path = std::filesystem::path(BINARY_DIR) / "test_files" / "exchange";
  std::filesystem::create_directories(path);
  return path.string();
}

// two bodies, overlapping sets of facets, points, a node set that no facets make
Mesh example() {
  Mesh mesh = test::block(test::even(0, 3, 3), test::even(0, 2, 2), test::even(-1, 1, 2));
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    mesh.X[n] += 1e-3 * Vec3(std::sin(n), std::cos(3. * n), std::sin(5. * n));
  mesh.bodies = {"dermis", "epidermis"};
  mesh.body.clear();
  for (int e = 0; e < mesh.n_cells(); ++e) mesh.body.push_back(mesh.X[mesh.cell(e)[0]][1] > 0.5);
  mesh.node_sets.clear(), mesh.facet_sets.clear();
  const std::vector<Facet> outer = boundary(mesh);
  std::vector<Facet> upper, right;
  for (const Facet& f : outer) {
    if (f.local == 3) upper.push_back(f);
    if (f.local == 1 || (f.local == 3 && f.cell % 3 == 2)) right.push_back(f);
  }
  name_facets(mesh, "upper", upper);
  name_facets(mesh, "right side", right);  // shares facets with it
  mesh.node_sets["A"] = {7};
  mesh.node_sets["some"] = {0, 3, 7, 11};
  mesh.node_sets["upper"].push_back(0);  // more than the nodes of its facets
  std::sort(mesh.node_sets["upper"].begin(), mesh.node_sets["upper"].end());
  return mesh;
}

std::vector<std::vector<int>> as_nodes(const Mesh& mesh, const std::vector<Facet>& facets) {
  std::vector<std::vector<int>> all;
  for (const Facet& f : facets) all.push_back(facet_nodes(mesh, f));
  std::sort(all.begin(), all.end());
  return all;
}

void check_same(const Mesh& a, const Mesh& b, double tolerance) {
  REQUIRE(a.n_nodes() == b.n_nodes());
  for (int n = 0; n < a.n_nodes(); ++n) CHECK((a.X[n] - b.X[n]).norm() <= tolerance);
  CHECK(a.connectivity == b.connectivity);
  CHECK(a.bodies == b.bodies);
  CHECK(a.body == b.body);
  CHECK(a.node_sets == b.node_sets);
  REQUIRE(a.facet_sets.size() == b.facet_sets.size());
  for (const auto& [name, facets] : a.facet_sets) {
    const auto named = name;
    INFO(named);
    REQUIRE(b.facet_sets.count(name));
    CHECK(as_nodes(a, facets) == as_nodes(b, b.facet_sets.at(name)));
  }
}

std::string refusal(const std::string& text) {
  std::vector<std::string> notes;
  try {
    parse_inp(text, "m.inp", notes);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "";
}

const std::string cube =
    "*Heading\n a cube\n** remark\n*NODE, NSET=all\n1, 0., 0., 0.\n2, 1.,0.,0.\n3,1.,1.,0.\n4,0.,1.0D0,0.\n"
    "5,0,0,1\n6,1,0,1\n7,1,1,+1.e0\n8,0,1,1\n99,5,5,5\n*Element, type=C3D8R,\n elset=Cube\n10, 1,2,3,4,\n5,6,7,8\n";

}  // namespace

TEST_CASE("a mesh goes to Gmsh and back with its bodies and sets and every digit") {
  const Mesh mesh = example();
  const std::string path = folder() + "/m.msh";
  std::ofstream(path) << msh_text(mesh);
  std::vector<std::string> notes;
  check_same(mesh, read_msh(path, notes), 0);
  CHECK(notes.empty());
  Mesh odd = mesh;
  odd.bodies[0] = "a \"b\"";
  CHECK_THROWS_AS(msh_text(odd), Failure);
}

TEST_CASE("a mesh goes to Abaqus and back with its bodies and sets and every digit") {
  const Mesh mesh = example();
  std::vector<std::string> notes;
  check_same(mesh, parse_inp(inp_text(mesh), "m.inp", notes), 0);
  CHECK(notes.empty());
  Mesh odd = mesh;
  odd.bodies[0] = "a, b";
  CHECK_THROWS_AS(inp_text(odd), Failure);
}

TEST_CASE("what an .inp may say of a mesh is read, what it says of a model is left out by name") {
  std::vector<std::string> notes;
  const Mesh mesh = parse_inp(
      cube +
          "*NSET, NSET=Odd, GENERATE\n1, 7, 2\n*NSET,NSET=both\nodd, 2\n*ELSET, ELSET=E\n10\n"
          "*SURFACE, NAME=base, TYPE=ELEMENT\ne, s1\n*SURFACE, NAME=dots, TYPE=NODE\nodd\n"
          "*SOLID SECTION, ELSET=CUBE, MATERIAL=skin\n1.\n*MATERIAL, NAME=skin\n*HYPERELASTIC\n1, 2\n*STEP\n*STATIC\n*END STEP\n",
      "m.inp", notes);
  CHECK(mesh.n_nodes() == 8);  // node 99 is of no cell
  CHECK(mesh.n_cells() == 1);
  CHECK(mesh.bodies == std::vector<std::string>{"Cube"});
  CHECK(quality(mesh).volume == near(1));
  CHECK(mesh.node_sets.at("Odd") == std::vector<int>{0, 2, 4, 6});
  CHECK(mesh.node_sets.at("both") == std::vector<int>{0, 1, 2, 4, 6});
  CHECK(mesh.node_sets.at("dots") == mesh.node_sets.at("Odd"));
  CHECK(mesh.node_sets.at("all").size() == 8);
  CHECK(mesh.node_sets.at("base") == std::vector<int>{0, 1, 2, 3});
  CHECK(notes ==
        std::vector<std::string>{
            "left out, as they are no bodies: element sets E",
            "the material skin of Cube for a solve config, with the numbers of the file: material: "
            "{matrix: {mooney_rivlin: {c10: 1, c01: 2}}, volume: {quadratic: "
            "{d: 0.0003333333333333333}}}; D1 is 0, incompressible: d makes the bulk modulus 1000 "
            "times the shear modulus",
            "left out, as they are no mesh: *END STEP, *STATIC, *STEP"});
}

TEST_CASE("an .inp that is wrong is refused with its line") {
  CHECK(
      refusal("*NODE\n1, 0, 0, 0\n")
          .starts_with("m.inp: no hexahedra or tetrahedra; expected *ELEMENT, TYPE=, one of C3D8"));
  CHECK(refusal("*NODE\n1, 0, zero, 0\n")
            .starts_with("m.inp:2:1: found \"zero\"; expected a number"));
  CHECK(refusal("*NODE\n1, 0, 0, 0\n1, 0, 0, 0\n").starts_with("m.inp:3:1: node 1 is there twice"));
  CHECK(refusal("*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n")
            .starts_with("m.inp:2:1: element 1 has the node 1, which is not there"));
  CHECK(refusal("*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4\n*NODE\n")
            .starts_with("m.inp:2:1: an element of 4 nodes; expected 8 nodes"));
  CHECK(
      refusal(cube + "*NSET, NSET=n\nm\n").starts_with("m.inp:19:1: there is no set \"m\" above"));
  CHECK(refusal(cube + "*NSET, NSET=n, GENERATE\n5, 1, 1\n")
            .starts_with("m.inp:19:1: a range that does not ascend"));
  CHECK(refusal(cube + "*SURFACE, NAME=s\n10, S7\n")
            .starts_with("m.inp:19:1: found the side \"S7\"; expected S1 to S6"));
  CHECK(refusal(cube + "*SURFACE, NAME=s\n11, S1\n")
            .starts_with("m.inp:19:1: there is no element 11"));
  CHECK(refusal("*INCLUDE, INPUT=other.inp\n").starts_with("m.inp:1:1: found *INCLUDE"));
  CHECK(refusal("*INSTANCE, NAME=i, PART=p\n1, 0, 0\n")
            .starts_with("m.inp:1:1: there is no *PART \"p\" above"));
}

TEST_CASE("a .msh without hexahedra, or none at all, is refused") {
  std::vector<std::string> notes;
  const std::string path = folder() + "/wrong.msh";
  const auto said = [&](const std::string& text) -> std::string {
    std::ofstream(path) << text;
    try {
      read_msh(path, notes);
    } catch (const Failure& failure) {
      CHECK(failure.code() == Exit::input);
      return failure.what();
    }
    return "";
  };
  const std::string head =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n";
  CHECK(said(head + "$Elements\n1\n1 7 2 1 1 1 2 3 4 4\n$EndElements\n")
            .find("found cells of the kind Pyramid 5; expected 8-node hexahedra only") !=
        std::string::npos);
  CHECK(said(head).find("no cells") != std::string::npos);
  CHECK(said("no mesh\n") != "");
}

TEST_CASE(
    "a solid of CAD becomes hexahedra, its faces sets, its bodies bodies that share their nodes") {
  const std::string path = folder() + "/two.step";
  {
    const GmshSession session;  // a cylinder of radius 6 on a box
    gmsh::model::occ::addBox(-8, 0, -8, 16, 2, 16);
    gmsh::model::occ::addCylinder(0, 2, 0, 0, 2, 0, 6);
    gmsh::model::occ::synchronize();
    gmsh::write(path);
  }
  std::vector<std::string> notes;
  const Mesh mesh = read_solid(path, {false, 1.5, CellType::hex8}, notes);
  CHECK(mesh.bodies.size() == 2);
  const Quality q = quality(mesh);
  CHECK(q.least_jacobian > 0);  // flat tetrahedra make flat hexahedra, none is folded
  CHECK(q.volume == near(16 * 16 * 2 + 3.141592653589793 * 36 * 2, 0.02));
  CHECK(q.longest_edge < 4.5);
  CHECK_FALSE(coincident_nodes(mesh, 1e-6));
  CHECK(mesh.facet_sets.size() == 6 + 2 + 1);  // box, cylinder, the circle between them once
  const std::vector<Facet> outer = boundary(mesh);
  for (const Facet& f : outer) {
    int named = 0;
    for (const auto& [name, facets] : mesh.facet_sets)
      for (const Facet& g : facets) named += g.cell == f.cell && g.local == f.local;
    CHECK(named == 1);
  }
  // as tetrahedra
  const Mesh split = read_solid(path, {false, 3, CellType::tet15}, notes);
  CHECK(split.type == CellType::tet15);
  CHECK(split.bodies == mesh.bodies);
  CHECK(quality(split).least_jacobian > 0);
  CHECK(quality(split).volume ==
        near(16 * 16 * 2 + 3.141592653589793 * 36 * 2, 0.05));  // straight edges
  CHECK(split.facet_sets.size() == mesh.facet_sets.size());
  CHECK_FALSE(coincident_nodes(split, 1e-6));
  for (const Facet& f : boundary(split)) {
    int named = 0;
    for (const auto& [name, facets] : split.facet_sets)
      for (const Facet& g : facets) named += g.cell == f.cell && g.local == f.local;
    CHECK(named == 1);
  }
  const std::string tetrahedra = folder() + "/tetrahedra.msh";
  {
    const GmshSession session;
    gmsh::model::occ::addBox(0, 0, 0, 6, 2, 4);
    gmsh::model::occ::synchronize();
    gmsh::model::setPhysicalName(3, gmsh::model::addPhysicalGroup(3, {1}), "flesh");
    gmsh::model::setPhysicalName(2, gmsh::model::addPhysicalGroup(2, {1, 2}), "ends");
    gmsh::option::setNumber("Mesh.MeshSizeMax", 1.5);
    const NoTraps in_gmsh;
    gmsh::model::mesh::generate(3);
    gmsh::write(tetrahedra);
  }
  const Mesh read = read_msh(tetrahedra, notes);
  CHECK(read.type == CellType::tet15);
  CHECK(read.bodies == std::vector<std::string>{"flesh"});
  CHECK(quality(read).volume == near(48, 1e-12));
  for (int n : read.node_sets.at("ends"))
    CHECK((std::abs(read.X[n][0]) < 1e-9 || std::abs(read.X[n][0] - 6) < 1e-9));
  CHECK(nodal_areas(read, read.facet_sets.at("ends")).sum() == near(2 * 2 * 4, 1e-12));
  {
    const GmshSession session;
    gmsh::model::occ::addSphere(0, 0, 0, 5);
    gmsh::model::occ::synchronize();
    gmsh::write(path);
  }
  const Mesh ball = read_solid(path, {false, 1, CellType::hex8}, notes);
  CHECK(ball.bodies == std::vector<std::string>{""});
  CHECK(quality(ball).volume == near(4. / 3 * 3.141592653589793 * 125, 0.03));
  // the same ball and a box as triangles
  const std::string facets = folder() + "/facets.stl";
  const auto meshed = [&](auto add) {
    const GmshSession session;
    add();
    gmsh::model::occ::synchronize();
    gmsh::option::setNumber("Mesh.MeshSizeMax", 1);
    const NoTraps in_gmsh;
    gmsh::model::mesh::generate(2);
    gmsh::write(facets);
  };
  meshed([] { gmsh::model::occ::addBox(0, 0, 0, 6, 2, 4); });
  const Mesh box = read_solid(facets, {true, 1, CellType::hex8}, notes);
  CHECK(quality(box).volume == near(48, 1e-6));
  CHECK(quality(box).least_jacobian > 0);
  CHECK(box.facet_sets.size() >= 6);  // gmsh may cut a face of triangles into several
  meshed([] { gmsh::model::occ::addSphere(0, 0, 0, 5); });
  CHECK(quality(read_solid(facets, {true, 1, CellType::hex8}, notes)).volume ==
        near(4. / 3 * 3.141592653589793 * 125, 0.03));
  std::ofstream(folder() + "/no.stl") << "nothing";
  CHECK_THROWS_AS((read_solid(folder() + "/no.stl", {true, 1, CellType::hex8}, notes)), Failure);
  std::ofstream(folder() + "/no.step") << "nothing";
  CHECK_THROWS_AS((read_solid(folder() + "/no.step", {false, 1, CellType::hex8}, notes)), Failure);
}

}  // namespace exchange_tests
