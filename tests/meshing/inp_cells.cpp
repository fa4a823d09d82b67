// Cells of Abaqus and CalculiX that become ours: places of all nodes, those between the file's too,
// and the sets that these belong to.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "core/base/error.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/quality.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/mesh/select.hpp"
#include "meshing/exchange.hpp"
#include "support/block.hpp"

using namespace langer;

namespace inp_cells_tests {

namespace {

// from the manuals: our node of each of theirs
std::vector<int> first(int n) {
  std::vector<int> nodes(static_cast<std::size_t>(n));
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}
std::vector<int> c3d27() {  // the middle of the cell, then those of S1 (1-2-3-4), S2 (5-8-7-6), S3
                            // (1-5-6-2), S4, S5, S6
  std::vector<int> nodes = first(20);
  nodes.insert(nodes.end(), {26, 24, 25, 22, 21, 23, 20});
  return nodes;
}

// Numbers are those of the mesh; what the cell of the file lacks is left out of nodes and sets.
std::string written(const Mesh& mesh, const std::string& type, const std::vector<int>& theirs) {
  std::vector<bool> is_there(mesh.X.size());
  std::string elements = "*ELEMENT, TYPE=" + type + ", ELSET=skin\n", text = "*NODE\n";
  for (int e = 0; e < mesh.n_cells(); ++e) {
    elements += std::to_string(e + 1);
    int on_line = 1;
    for (int a : theirs) {
      const int n = mesh.cell(e)[static_cast<std::size_t>(a)];
      is_there[static_cast<std::size_t>(n)] = true;
      elements += (on_line++ % 16 == 0 ? ",\n" : ", ") + std::to_string(n + 1);
    }
    elements += "\n";
  }
  for (int n = 0; n < mesh.n_nodes(); ++n)
    if (is_there[static_cast<std::size_t>(n)])
      text += fmt::format("{}, {}, {}, {}\n", n + 1, mesh.X[n][0], mesh.X[n][1], mesh.X[n][2]);
  text += elements;
  for (const auto& [name, nodes] : mesh.node_sets) {
    text += "*NSET, NSET=" + name + "\n";
    for (int n : nodes)
      if (is_there[static_cast<std::size_t>(n)]) text += std::to_string(n + 1) + "\n";
  }
  return text;
}

Mesh read(const std::string& text) {
  std::vector<std::string> notes;
  return parse_inp(text, "m.inp", notes);
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::input);
    return failure.what();
  }
  return "read";
}

// sides, two of them together, an edge and the whole: what a set of nodes may be
Mesh with_sets(Mesh mesh) {
  name_sides(mesh);
  mesh.facet_sets.clear(), mesh.node_sets.erase("top"), mesh.node_sets.erase("bottom");
  const auto x = mesh.node_sets.at("x_min"), z = mesh.node_sets.at("z_min");
  std::vector<int> corner, edge, all(mesh.X.size());
  std::set_union(x.begin(), x.end(), z.begin(), z.end(), std::back_inserter(corner));
  std::set_intersection(x.begin(), x.end(), z.begin(), z.end(), std::back_inserter(edge));
  std::iota(all.begin(), all.end(), 0);
  mesh.node_sets["corner"] = corner, mesh.node_sets["edge"] = edge, mesh.node_sets["all"] = all,
  mesh.node_sets["A"] = {0};
  return mesh;
}

// a quadratic map of the whole: cells with corners and middles of edges can show it
void curve(Mesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-0.02, 0.02);
  Mat3 second[3];
  for (Mat3& q : second)
    for (double& entry : q.reshaped()) entry = u(random);
  for (Vec3& x : mesh.X) {
    const Vec3 y = x;
    for (int k = 0; k < 3; ++k) x[k] += y.dot(second[k] * y);
  }
}

void check_same(const Mesh& mesh, const Mesh& found, double tolerance) {
  REQUIRE(found.type == mesh.type);
  REQUIRE(found.n_cells() == mesh.n_cells());
  REQUIRE(found.n_nodes() == mesh.n_nodes());
  std::vector<int> ours(mesh.X.size(), -1);  // by node found
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (std::size_t a = 0; a < mesh.cell(e).size(); ++a) {
      int& known = ours[static_cast<std::size_t>(found.cell(e)[a])];
      CHECK((known < 0 || known == mesh.cell(e)[a]));
      known = mesh.cell(e)[a];
    }
  for (int n = 0; n < mesh.n_nodes(); ++n)
    CHECK((found.X[n] - mesh.X[ours[static_cast<std::size_t>(n)]]).norm() <= tolerance);
  for (const auto& set : mesh.node_sets) {
    const std::string& name = set.first;
    CAPTURE(name);
    std::vector<int> nodes;
    for (int n : found.node_sets.at(name)) nodes.push_back(ours[static_cast<std::size_t>(n)]);
    std::sort(nodes.begin(), nodes.end());
    CHECK(nodes == set.second);
    CHECK(std::is_sorted(found.node_sets.at(name).begin(), found.node_sets.at(name).end()));
  }
}

}  // namespace

TEST_CASE(
    "curved cells with middles of edges keep their shape, and their sets take the nodes between") {
  const Mesh blocks[]{test::block({0, 1, 2.5}, {0, 0.8, 2}, {-1, 0.2, 1}),
                      test::block({0, 1.5}, {0, 1}, {0, 0.7, 2, 3})};
  unsigned seed = 1;
  for (const Mesh& linear : blocks) {
    Mesh hexahedra = with_sets(raised(linear, CellType::hex27)),
         tetrahedra = with_sets(test::tetrahedra(linear));
    curve(hexahedra, ++seed), curve(tetrahedra, ++seed);
    REQUIRE(quality(hexahedra).least_jacobian > 0);
    REQUIRE(quality(tetrahedra).least_jacobian > 0);
    for (const char* type : {"C3D20", "C3D20R", "c3d20rh"})
      check_same(hexahedra, read(written(hexahedra, type, first(20))), 1e-14);
    for (const char* type : {"C3D10", "C3D10M", "C3D10MH"})
      check_same(tetrahedra, read(written(tetrahedra, type, first(10))), 1e-14);
    check_same(hexahedra, read(written(hexahedra, "C3D27", c3d27())), 0);
  }
}

TEST_CASE(
    "tetrahedra of four nodes get those between them, which no edge within the body adds to a set") {
  Mesh mesh = with_sets(test::tetrahedra(test::block({0, 1, 2.5}, {0, 0.8, 2}, {-1, 0.2, 1})));
  mesh.node_sets["through"] = {0, 13};  // a corner and the middle of the block
  mesh.node_sets["along"] = {0, 1};
  for (int n = 2; n < mesh.n_nodes(); ++n)
    if ((mesh.X[n] - 0.5 * (mesh.X[0] + mesh.X[1])).norm() < 1e-12)
      mesh.node_sets["along"].push_back(n);
  REQUIRE(mesh.node_sets["along"].size() == 3);
  REQUIRE((mesh.X[13] - Vec3(1, 0.8, 0.2)).norm() < 1e-12);
  check_same(mesh, read(written(mesh, "C3D4", first(4))), 1e-15);
}

TEST_CASE("sides of every cell are those of the manuals: the corners of each, from 1") {
  const std::vector<std::vector<int>> of_hexahedron{{1, 2, 3, 4}, {5, 8, 7, 6}, {1, 5, 6, 2},
                                                    {2, 6, 7, 3}, {3, 7, 8, 4}, {4, 8, 5, 1}},
      of_tetrahedron{{1, 2, 3}, {1, 4, 2}, {2, 4, 3}, {3, 4, 1}};
  const Mesh linear = test::block({0, 1}, {0, 1}, {0, 1});
  const auto check = [](const Mesh& mesh, const std::string& type, const std::vector<int>& theirs,
                        const std::vector<std::vector<int>>& sides) {
    for (std::size_t s = 0; s < sides.size(); ++s) {
      const Mesh found =
          read(written(mesh, type, theirs) + fmt::format("*SURFACE, NAME=side\n1, S{}\n", s + 1));
      const auto facet = found.facet_sets.at("side");
      REQUIRE(facet.size() == 1);
      std::vector<int> nodes = facet_nodes(found, facet[0]), corners;
      for (int a : sides[s]) corners.push_back(found.cell(0)[static_cast<std::size_t>(a) - 1]);
      nodes.resize(corners.size());
      CHECK(std::is_permutation(nodes.begin(), nodes.end(), corners.begin()));
      CHECK(found.node_sets.at("side").size() == facet_nodes(found, facet[0]).size());
    }
    CHECK(refusal(written(mesh, type, theirs) +
                  fmt::format("*SURFACE, NAME=side\n1, S{}\n", sides.size() + 1))
              .find(fmt::format("found the side \"S{}\"; expected S1 to S{}", sides.size() + 1,
                                sides.size())) != std::string::npos);
  };
  const Mesh hexahedron = raised(linear, CellType::hex27), tetrahedra = test::tetrahedra(linear);
  check(linear, "C3D8I", first(8), of_hexahedron);
  check(hexahedron, "C3D20", first(20), of_hexahedron);
  check(hexahedron, "C3D27", c3d27(), of_hexahedron);
  check(tetrahedra, "C3D4", first(4), of_tetrahedron);
  check(tetrahedra, "C3D10", first(10), of_tetrahedron);
}

TEST_CASE("cells that are none of ours, two kinds, or too few nodes are refused at their line") {
  CHECK(
      refusal("*ELEMENT, TYPE=C3D15\n1, 1, 2\n") ==
      "m.inp:1:1: found elements C3D15; expected one of C3D8, C3D20, C3D27, C3D4, C3D10, or the like with R, H, I, M or S behind");
  for (const char* type : {"C3D6", "C3D8P", "C3D10T", "C3D2", "C3D100", "C3D27V"})
    CHECK(refusal(std::string("*ELEMENT, TYPE=") + type + "\n")
              .starts_with(std::string("m.inp:1:1: found elements ") + type));
  const std::string eight = "*ELEMENT, TYPE=C3D8R\n1, 1, 2, 3, 4, 5, 6, 7, 8\n";
  CHECK(refusal(eight + "*ELEMENT, TYPE=C3D10\n")
            .starts_with(
                "m.inp:3:1: found elements C3D10 together with C3D8R; expected cells of one kind"));
  CHECK(refusal(eight + "*ELEMENT, TYPE=C3D20\n")
            .starts_with("m.inp:3:1: found elements C3D20 together with C3D8R"));
  CHECK(refusal("*ELEMENT, TYPE=C3D10\n1, 1, 2, 3, 4,\n5, 6, 7\n*NODE\n")
            .starts_with("m.inp:2:1: an element of 7 nodes; expected 10"));
  const Mesh mesh = test::tetrahedra(test::block({0, 1}, {0, 1}, {0, 1}));
  CHECK(refusal("*SURFACE, NAME=side\n1, S5\n" + written(mesh, "C3D10", first(10)))
            .starts_with("m.inp:2:1: found the side \"S5\"; expected S1 to S4"));
}

}  // namespace inp_cells_tests
