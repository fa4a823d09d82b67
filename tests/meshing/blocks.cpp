// Structured meshes, from the project's own configs and from configs made up to go wrong.
#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <set>

#include "mechanics/mesh/reference.hpp"
#include "scene/model/make_mesh.hpp"
#include "scene/model/solve_config_io.hpp"

using namespace langer;

namespace {

MadeMesh made(Tree tree) {
  const auto loaded = read_config<MeshConfig>(std::move(tree));
  return make_mesh(loaded.config, loaded.where);
}
MadeMesh from_file(const std::string& name) {
  return made(load_yaml(std::string(SOURCE_DIR) + "/configs/mesh/" + name + ".yaml"));
}
MadeMesh from_text(const std::string& text) { return made(parse_yaml(text, "mesh.yaml")); }

std::string refusal(const std::string& text) {
  try {
    from_text(text);
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::config);
    return failure.what();
  }
  return "";
}
bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

struct Less {
  bool operator()(const Vec3& a, const Vec3& b) const {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  }
};

Vec3 at(const MadeMesh& made, const std::string& point) {
  const auto& set = made.mesh.node_sets.at(point);
  REQUIRE(set.size() == 1);
  return made.mesh.X[set[0]];
}

}  // namespace

TEST_CASE(
    "every mesh config makes a mesh that fills its block, whose cells are not folded and turn with the axes") {
  for (const char* name : {"cube_1_8", "indentation", "indentation_hex27", "brick_regular",
                           "brick_graded", "indentation_56x4x55", "smoke"}) {
    CAPTURE(std::string(name));
    const MadeMesh m = from_file(name);
    const double volume = std::string(name) == "smoke" ? 12 * 4 * 12 : 30 * 4 * 30;
    const double rounding =
        nodes_per_cell(m.mesh.type) * m.mesh.n_cells() * 2.2e-16;  // of a sum over all Gauss points
    CHECK(std::abs(m.quality.volume - volume) <= rounding * volume);
    CHECK(m.quality.least_jacobian > 0);
    CHECK(m.quality.least_scaled_jacobian > 0.7);
    for (int e = 0; e < m.mesh.n_cells() && std::string(name) != "brick_graded"; ++e)
      CHECK(jacobian(m.mesh, e, Vec3::Zero()).diagonal().minCoeff() > 0);
    std::set<Vec3, Less> places(m.mesh.X.begin(), m.mesh.X.end());
    CHECK(places.size() == m.mesh.X.size());
    for (const Mat3& frame : m.mesh.frames)
      CHECK((frame.transpose() * frame - Mat3::Identity()).norm() < 1e-14);
    CHECK(m.mesh.frames.size() == static_cast<std::size_t>(m.mesh.n_cells()));
  }
}

TEST_CASE("a block has the cells it was asked for") {
  CHECK(from_file("cube_1_8").mesh.n_cells() == 1);
  CHECK(from_file("cube_1_8").mesh.n_nodes() == 8);
  CHECK(from_file("indentation_56x4x55").mesh.n_cells() == 12320);
  const MadeMesh m = from_file("indentation");
  CHECK(m.mesh.n_cells() == 22 * 5 * 22);
  CHECK(m.mesh.n_nodes() == 23 * 6 * 23);
  CHECK(from_file("indentation_hex27").mesh.n_cells() == 12 * 4 * 12);
  CHECK(from_file("indentation_hex27").mesh.n_nodes() == 25 * 9 * 25);
  const MadeMesh ring = from_file("brick_graded");
  CHECK(ring.mesh.n_cells() == 5 * (8 * 8 + 4 * 8 * (5 + 3 + 6)));
}

TEST_CASE(
    "longer cells of an indented block are fewer by one factor along all axes, as nearly as whole numbers are") {
  const double wide[]{30, 24}, thick[]{4, 2.3};
  for (double width : wide)
    for (double thickness : thick)
      for (double edge : {0.18, 0.15, 0.125, 0.1, 0.0707}) {
        CAPTURE(edge);
        IndentedBlock block{{-15, 0, -12}, {30, thickness, width}, 2.5, 1, edge};
        const auto n = block.block().divisions;
        CHECK(!block.block().instead);
        double last = 1;
        for (double longer : {1.25, 1.5}) {
          CAPTURE(longer);
          block.longer = longer;
          const Block other = block.block();
          REQUIRE(other.instead);
          CHECK(other.divisions == n);
          const auto factor = [&](int axis) {
            return 1.0 * n[axis] / (*other.instead)[axis];
          };
          const double mean = std::cbrt(factor(0) * factor(1) * factor(2));
          CHECK(mean > 1.05 * last);
          CHECK(std::abs(mean / longer - 1) < 0.15);
          for (int axis : {0, 1, 2}) CHECK(std::abs(factor(axis) / mean - 1) < 0.06);
          last = mean;
        }
      }
}

TEST_CASE("observation points are nodes, to the last digit") {
  for (const char* name :
       {"indentation", "indentation_hex27", "brick_regular", "brick_graded", "smoke"}) {
    CAPTURE(std::string(name));
    const MadeMesh m = from_file(name);
    CHECK(at(m, "M") == Vec3(0, 4, 0));
    CHECK(at(m, "A") == Vec3(4, 4, 0));
    CHECK(at(m, "B") == Vec3(0, 4, 4));
    CHECK(at(m, "C") == Vec3(-4, 4, 0));
    CHECK(at(m, "D") == Vec3(0, 4, -4));
  }
  CHECK(at(from_file("cube_1_8"), "B") == Vec3(30, 4, 30));
}

TEST_CASE(
    "meshes around a centre are mirrored in x and z and unchanged when x and z change places, to the last digit") {
  for (const char* name :
       {"indentation", "indentation_hex27", "brick_regular", "brick_graded", "smoke"}) {
    CAPTURE(std::string(name));
    const MadeMesh m = from_file(name);
    const std::set<Vec3, Less> places(m.mesh.X.begin(), m.mesh.X.end());
    for (const Vec3& x : m.mesh.X) {
      CHECK(places.count({-x[0], x[1], x[2]}) == 1);
      CHECK(places.count({x[0], x[1], -x[2]}) == 1);
      CHECK(places.count({x[2], x[1], x[0]}) == 1);
    }
  }
}

TEST_CASE("the same config gives the same mesh") {
  const MadeMesh a = from_file("brick_graded"), b = from_file("brick_graded");
  CHECK(a.mesh.X == b.mesh.X);
  CHECK(a.mesh.connectivity == b.mesh.connectivity);
}

TEST_CASE("in the O-grid each cell's first edge points outwards, and its frame follows it") {
  for (const char* blocks : {"turned", "mirrored"}) {
    CAPTURE(std::string(blocks));
    Tree tree = load_yaml(std::string(SOURCE_DIR) + "/configs/mesh/brick_graded.yaml");
    set_value(tree, "geometry.graded_block.blocks",
              parse_yaml(std::string("{b: ") + blocks + "}", "-").map[0].value);
    const MadeMesh m = made(std::move(tree));
    int core = 0, along[4] = {0, 0, 0, 0}, alike = 0, rings = 0;
    for (int e = 0; e < m.mesh.n_cells(); ++e) {
      Vec3 centre = Vec3::Zero();
      for (int n : m.mesh.cell(e)) centre += m.mesh.X[n] / 8;
      centre[1] = 0;
      const Mat3& frame = m.mesh.frames[e];
      const auto nodes = m.mesh.cell(e);
      CHECK(frame.col(0).dot((m.mesh.X[nodes[1]] - m.mesh.X[nodes[0]]).normalized()) > 0.9);
      CHECK(std::abs(std::abs(frame(1, 1)) - 1) <
            1e-12);  // the layers are level: the angle is measured in them
      if (centre.lpNorm<Eigen::Infinity>() < 1) {
        CHECK((frame - Mat3::Identity()).norm() < 1e-14);
        ++core;
        continue;
      }
      ++rings;
      CHECK(frame.col(0).dot(centre.normalized()) > std::cos(30 * 3.14159 / 180));
      const int side = std::abs(centre[0]) > std::abs(centre[2]) ? (centre[0] > 0 ? 0 : 2)
                                                                 : (centre[2] > 0 ? 1 : 3);
      ++along[side];
      // the cell opposite through the axis
      for (int o = 0; o < m.mesh.n_cells(); ++o) {
        Vec3 other = Vec3::Zero();
        for (int n : m.mesh.cell(o)) other += m.mesh.X[n] / 8;
        if (std::abs(m.mesh.X[m.mesh.cell(o)[0]][1] - m.mesh.X[nodes[0]][1]) > 1.5 ||
            (Vec3(other[0], 0, other[2]) + centre).norm() > 1e-9)
          continue;
        const Vec3 a = frame.col(0) + frame.col(2),
                   b = m.mesh.frames[o].col(0) + m.mesh.frames[o].col(2);
        alike += a.cross(b).norm() < 1e-9;
        break;
      }
    }
    CHECK(core == 5 * 64);
    for (int n : along) CHECK(n == 5 * 8 * 14);
    CHECK(alike == (std::string(blocks) == "turned"
                        ? rings
                        : 0));  // half a turn maps the fibres to themselves, or does not
  }
  for (const Mat3& frame : from_file("brick_regular").mesh.frames) CHECK(frame == Mat3::Identity());
}

TEST_CASE(
    "sets: the contact candidates are the top nodes near the axis, with the facets between them") {
  const MadeMesh m = from_file("indentation");
  const auto& contact = m.mesh.node_sets.at("contact");
  std::vector<int> expected;
  for (int n = 0; n < m.mesh.n_nodes(); ++n)
    if (m.mesh.X[n][1] == 4 && std::hypot(m.mesh.X[n][0], m.mesh.X[n][2]) <= 2.8)
      expected.push_back(n);
  CHECK(contact == expected);
  CHECK(contact.size() > 100);
  for (const Facet& f : m.mesh.facet_sets.at("contact")) {
    CHECK(f.local == 3);
    for (int a : Hex8::facet[3])
      CHECK(std::binary_search(contact.begin(), contact.end(), m.mesh.cell(f.cell)[a]));
  }
}

TEST_CASE("what a mesh config gets wrong is said at its line") {
  const std::string block = "geometry:\n  block:\n    size: [4, 4, 4]\n    divisions: [2, 2, 2]\n";
  CHECK(refusal(block) == "");
  CHECK(holds(refusal(block + "points:\n  A: [5, 4, 0]\n"),
              "mesh.yaml:6:3: points.A: x = 5 is outside the block; expected 0 to 4"));
  CHECK(holds(refusal(block + "points:\n  A: [1.9, 0, 0]\n  B: [2.1, 0, 0]\n"),
              "mesh.yaml:7:3: points.B: no grid line is left for x = 2.1"));
  CHECK(holds(refusal(block + "points:\n  top: [0, 0, 0]\n"),
              "mesh.yaml:6:3: points.top: found the name of a side"));
  CHECK(holds(
      refusal(block + "points:\n  A: [0, 0, 0]\nsets:\n  A: {within: {plane: {axis: x, at: 0}}}\n"),
      "mesh.yaml:8:3: sets.A: found the name of a point"));
  CHECK(holds(refusal(block + "sets:\n  s: {within: {plane: {axis: x, at: 0.3}}}\n"),
              "mesh.yaml:6:3: sets.s: no node of the mesh is in this set"));
  CHECK(holds(refusal(block + "sets:\n  s: {of: roof, within: {plane: {axis: x, at: 0}}}\n"),
              "sets.s.of: found \"roof\"; expected one of x_min"));
  CHECK(holds(
      refusal(
          "geometry:\n  block:\n    size: [4, 4, 4]\n    divisions: [2, 2, 2]\n    centre: {edge: 3}\n"),
      "mesh.yaml:5:14: geometry.block.centre.edge: 1 cells of 3 mm are longer than 2 mm"));
  CHECK(holds(refusal("geometry: {block: {size: [4, 4, 4], divisions: [1000, 1000, 1000]}}\n"),
              "found 1000000000 cells"));
  CHECK(holds(refusal("geometry: {block: {size: [4, 0, 4], divisions: [2, 2, 2]}}\n"),
              "geometry.block.size[1]"));
}

TEST_CASE("an O-grid that cannot be is refused: order of radii, odd core, points off the nodes") {
  const auto ring = [](const std::string& core, const std::string& rings,
                       const std::string& rest = "") {
    return "geometry:\n  graded_block:\n    origin: [-6, 0, -6]\n    size: [12, 4, 12]\n    core: " +
           core + "\n    rings: " + rings + "\n    outer_cells: 3\n    layers: 1\n" + rest;
  };
  CHECK(refusal(ring("{half_width: 1, cells: 4}", "[{radius: 2, cells: 2}]")) == "");
  CHECK(holds(refusal(ring("{half_width: 1, cells: 5}", "[{radius: 2, cells: 2}]")),
              "core.cells: found 5; expected an even number"));
  CHECK(holds(refusal(ring("{half_width: 1, cells: 4}", "[{radius: 1.2, cells: 2}]")),
              "rings[0].radius: found 1.2; expected more than 1.41421"));
  CHECK(holds(
      refusal(ring("{half_width: 1, cells: 4}", "[{radius: 3, cells: 2}, {radius: 2, cells: 1}]")),
      "rings[1].radius"));
  CHECK(holds(refusal(ring("{half_width: 1, cells: 4}", "[{radius: 7, cells: 2}]")),
              "less than 6, half the block's width"));
  CHECK(holds(refusal(ring("{half_width: 1, cells: 4}", "[]")), "rings: found an empty list"));
  const std::string off = refusal(
      ring("{half_width: 1, cells: 4}", "[{radius: 2, cells: 2}]", "points:\n  A: [2.1, 4, 0]\n"));
  CHECK(holds(
      off, "mesh.yaml:10:3: points.A: no node is there; the nearest is 0.1 mm away, at (2, 4, 0)"));
}
