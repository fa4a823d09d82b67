// Quadratic cells: shape functions, nodes between the corners, facets, and everything a mesh is
// asked.
#include "mechanics/mesh/raise.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "mechanics/element/surface.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/order.hpp"
#include "mechanics/mesh/quality.hpp"
#include "mechanics/mesh/select.hpp"
#include "mesh/cells.hpp"
#include "support/near.hpp"

using namespace langer;

TEST_CASE(
    "hex27: shape functions are 1 at their node and 0 at the others, sum to 1, and their gradients are derivatives") {
  const ReferenceCell& cell = reference(27);
  for (int a = 0; a < 27; ++a) {
    const VecX N = cell.shape(cell.node[a]);
    for (int b = 0; b < 27; ++b) CHECK(N[b] == (a == b ? 1 : 0));
  }
  const Vec3 xi(0.3, -0.7, 0.45);
  CHECK(std::abs(cell.shape(xi).sum() - 1) < 1e-15);
  for (int k = 0; k < 3; ++k) {  // quadratic along each axis: differences are exact
    const Vec3 h = 0.1 * Vec3::Unit(k);
    CHECK((cell.gradient(xi).col(k) - (cell.shape(xi + h) - cell.shape(xi - h)) / 0.2).norm() <
          1e-14);
  }
}

TEST_CASE("hex27: the Gauss points integrate polynomials of degree 5 in each direction exactly") {
  const ReferenceCell& cell = reference(27);
  for (int p = 0; p <= 5; ++p)
    for (int q = 0; q <= 5; ++q) {
      double sum = 0;
      for (int g = 0; g < 27; ++g)
        sum += cell.weight[g] * std::pow(cell.gauss[g][0], p) * std::pow(cell.gauss[g][2], q);
      CHECK(sum == near(p % 2 || q % 2 ? 0 : 8.0 / ((p + 1) * (q + 1)), 1e-14, 1e-14));
    }
}

TEST_CASE(
    "hex27: facets list corners from outside, the middles between them, the middle of the facet") {
  const ReferenceCell& cell = reference(27);
  for (int f = 0; f < 6; ++f) {
    const auto& n = cell.facet[f];
    REQUIRE(n.size() == 9);
    for (int k = 0; k < 4; ++k) {
      CHECK(n[k] == Hex8::facet[f][k]);
      CHECK((cell.node[n[4 + k]] - (cell.node[n[k]] + cell.node[n[(k + 1) % 4]]) / 2).norm() == 0);
    }
    CHECK((cell.node[n[8]] - (cell.node[n[0]] + cell.node[n[2]]) / 2).norm() == 0);
    CHECK(n[8] == 20 + f);
  }
}

TEST_CASE(
    "tet15: shape functions are 1 at their node and 0 at the others, sum to 1, hold quadratic fields; gradients are derivatives") {
  const ReferenceCell& cell = reference(15);
  REQUIRE(cell.node.size() == 15);
  for (int a = 0; a < 15; ++a) {
    const VecX N = cell.shape(cell.node[a]);
    for (int b = 0; b < 15; ++b) CHECK(std::abs(N[b] - (a == b ? 1 : 0)) < 1e-15);
  }
  const Vec3 xi(0.2, 0.13, 0.4);
  CHECK(std::abs(cell.shape(xi).sum() - 1) < 1e-15);
  const auto field = [](const Vec3& x) {
    return 1 + x[0] - 2 * x[1] * x[2] + 3 * x[0] * x[0] - x[2] * x[2] + x[0] * x[1];
  };
  double value = 0;
  for (int a = 0; a < 15; ++a) value += cell.shape(xi)[a] * field(cell.node[a]);
  CHECK(value == near(field(xi), 1e-14));
  for (int k = 0; k < 3; ++k) {
    const Vec3 h = 1e-5 * Vec3::Unit(k);
    CHECK((cell.gradient(xi).col(k) - (cell.shape(xi + h) - cell.shape(xi - h)) / 2e-5).norm() <
          1e-8);
  }
}

TEST_CASE(
    "tet15: the points of the cell and of its facets integrate polynomials of degree 5 exactly") {
  const ReferenceCell& cell = reference(15);
  const auto factorial = [](int n) {
    return std::tgamma(n + 1);
  };
  for (int p = 0; p <= 5; ++p)
    for (int q = 0; p + q <= 5; ++q)
      for (int r = 0; p + q + r <= 5; ++r) {
        const auto f = [&](const Vec3& x) {
          return std::pow(x[0], p) * std::pow(x[1], q) * std::pow(x[2], r);
        };
        double sum = 0;
        for (int g = 0; g < cell.n_gauss; ++g) sum += cell.weight[g] * f(cell.gauss[g]);
        CHECK(sum ==
              near(factorial(p) * factorial(q) * factorial(r) / factorial(p + q + r + 3), 1e-13));
        if (r > 0) continue;
        double on_facet = 0;  // 0, zeta = 0
        for (const FacetPoint& x : cell.facet_points[0])
          on_facet += x.weight * f(x.xi) * x.along_1.cross(x.along_2).norm();
        CHECK(on_facet == near(factorial(p) * factorial(q) / factorial(p + q + 2), 1e-13));
      }
}

TEST_CASE(
    "tet15: facets list corners from outside, the middles between them, the middle; nodes have 1/20, 2/15 and 9/20 of each") {
  const ReferenceCell& cell = reference(15);
  Mesh mesh;
  mesh.type = CellType::tet15;
  for (int a = 0; a < 15; ++a) mesh.X.push_back(cell.node[a]), mesh.connectivity.push_back(a);
  for (int f = 0; f < 4; ++f) {
    const auto& n = cell.facet[f];
    REQUIRE(n.size() == 7);
    const auto x = [&](int k) {
      return cell.node[n[static_cast<std::size_t>(k)]];
    };
    const Vec3 area = (x(1) - x(0)).cross(x(2) - x(0)) / 2;
    CHECK(area.dot(x(0) - Vec3::Constant(0.25)) > 0);
    for (int k = 0; k < 3; ++k) CHECK((x(3 + k) - (x(k) + x((k + 1) % 3)) / 2).norm() < 1e-15);
    CHECK((x(6) - (x(0) + x(1) + x(2)) / 3).norm() < 1e-15);
    const VecX shares = nodal_areas(mesh, {{0, f}}) / area.norm();
    CHECK(shares.sum() == near(1, 1e-14));
    for (int k = 0; k < 7; ++k)
      CHECK(shares[n[k]] == near(k < 3 ? 1. / 20 : k < 6 ? 2. / 15 : 9. / 20, 1e-13));
  }
}

TEST_CASE(
    "raised: a block has (2n + 1)^3 nodes, each at the mean of its corners, and the volume it had") {
  Mesh linear = test::cube(3);
  test::distort(linear, 0.08);
  const Mesh mesh = raised(linear, CellType::hex27);
  CHECK(mesh.n_nodes() == 343);
  CHECK(mesh.n_cells() == 27);
  const Quality q = quality(mesh), before = quality(linear);
  CHECK(q.volume == near(before.volume, 1e-14));
  CHECK(q.shortest_edge == before.shortest_edge);
  CHECK(q.least_scaled_jacobian == near(before.least_scaled_jacobian, 1e-12));
  for (int e = 0; e < 27; ++e)
    for (int a = 0; a < 27; ++a) {
      Vec3 x = Vec3::Zero();
      const VecX N = Hex8::shape(reference(27).node[a]);
      for (int b = 0; b < 8; ++b) x += N[b] * linear.X[linear.cell(e)[b]];
      CHECK((mesh.X[mesh.cell(e)[a]] - x).norm() < 1e-15);
    }
}

TEST_CASE("raised: turning and numbering take nodes along, sides are named with all their nodes") {
  Mesh mesh = raised(test::block(test::even(-1, 1, 3), test::even(0, 1, 2), test::even(-2, 2, 4)),
                     CellType::hex27);
  const auto X = mesh.X;
  number_in_order(mesh);
  const Mesh numbered = mesh;
  turn_cells(mesh);
  CHECK(mesh.connectivity == numbered.connectivity);
  // cells turned a quarter about their zeta axis come back
  const ReferenceCell& cell = reference(27);
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int a = 0; a < 27; ++a) {
      const Vec3 xi(cell.node[a][1], -cell.node[a][0], cell.node[a][2]);
      for (int b = 0; b < 27; ++b)
        if (cell.node[b] == xi) mesh.connectivity[27 * e + a] = numbered.cell(e)[b];
    }
  CHECK(quality(mesh).least_jacobian > 0);
  CHECK(mesh.connectivity != numbered.connectivity);
  turn_cells(mesh);
  CHECK(mesh.connectivity == numbered.connectivity);

  mesh.node_sets.clear();
  name_sides(mesh);
  CHECK(mesh.node_sets.at("x_min").size() == 5 * 9);
  CHECK(mesh.node_sets.at("top").size() == 7 * 9);
  CHECK(mesh.facet_sets.at("top").size() == 12);
  CHECK(boundary(mesh).size() == 2 * (3 * 2 + 3 * 4 + 2 * 4));
  std::set<int> corners;
  for (const Facet& f : mesh.facet_sets.at("top"))
    for (const auto& quad : facet_quads(mesh, f)) corners.insert(quad.begin(), quad.end());
  CHECK(std::vector<int>(corners.begin(), corners.end()) == mesh.node_sets.at("top"));
}

TEST_CASE("the straight cells between the nodes of hex27 fill the same block and are not folded") {
  const Mesh quadratic = raised(test::block({0, 2, 3}, {0, 1}, {0, 3, 4}), CellType::hex27),
             parts = between_nodes(quadratic);
  CHECK(parts.n_cells() == 8 * 4);
  CHECK(parts.n_nodes() == quadratic.n_nodes());
  const Quality q = quality(parts);
  CHECK(q.volume == near(12, 1e-14));
  CHECK(q.least_scaled_jacobian == near(1, 1e-14));
  const Mesh tetrahedra = test::tetrahedra(test::block({0, 2, 3}, {0, 1}, {0, 3, 4})),
             in_them = between_nodes(tetrahedra);
  CHECK(in_them.n_cells() == 4 * 6 * 4);
  CHECK(quality(in_them).volume == near(12, 1e-14));
  CHECK(quality(in_them).least_jacobian > 0);
}

TEST_CASE(
    "nodes have their positive shares of a surface: 1, 4 and 16 parts of 36 in hex27, quarters in hex8") {
  for (CellType type : {CellType::hex8, CellType::hex27}) {
    const Mesh linear = test::block({0, 2, 3}, {0, 1}, {0, 3, 4});
    Mesh mesh = type == CellType::hex8 ? linear : raised(linear, type);
    mesh.node_sets.clear();
    name_sides(mesh);
    const VecX areas = nodal_areas(mesh, mesh.facet_sets.at("top"));
    CHECK(areas.sum() == near(12, 1e-14));
    for (int i = 0; i < mesh.n_nodes(); ++i) {
      const Vec3& X = mesh.X[i];
      const double expected = X[1] < 1               ? 0
                              : X == Vec3(0, 1, 0)   ? (type == CellType::hex8 ? 6.0 / 4 : 6.0 / 36)
                              : X == Vec3(1, 1, 1.5) ? 6 * 16.0 / 36
                              : X == Vec3(2, 1, 1.5) ? 6 * 4.0 / 36 + 3 * 4.0 / 36
                                                     : areas[i];
      CHECK(areas[i] == near(expected, 1e-14));
      CHECK((X[1] < 1 ? areas[i] == 0 : areas[i] > 0));
    }
    // a slanted plane keeps its area whichever side of the cells lies in it
    Mesh turned = mesh;
    const Mat3 R = example::turn(40, {1, 2, -1});
    for (Vec3& X : turned.X) X = R * X;
    for (const auto& [name, facets] : mesh.facet_sets)
      CHECK((nodal_areas(turned, facets) - nodal_areas(mesh, facets)).norm() < 1e-13);
  }
}
