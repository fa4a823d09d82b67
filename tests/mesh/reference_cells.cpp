// Every row of the cells: what holds for one holds for all, and a new one is tested by being there.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>
#include <set>

#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/quality.hpp"
#include "mechanics/mesh/raise.hpp"
#include "mechanics/mesh/reference.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// points inside the cell: means of its corners with positive weights
Vec3 inside(const ReferenceCell& cell, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0.01, 1);
  Vec3 sum = Vec3::Zero();
  double all = 0;
  for (int c = 0; c < cell.n_corners; ++c) {
    const double w = share(random);
    sum += w * cell.node[c], all += w;
  }
  return sum / all;
}

// one cell whose nodes are those of the reference cell, moved by a linear map
Mesh alone(const ReferenceCell& cell, const Mat3& F = Mat3::Identity()) {
  Mesh mesh;
  mesh.type = cell.type;
  for (int a = 0; a < cell.n_nodes; ++a)
    mesh.X.push_back(F * cell.node[a]), mesh.connectivity.push_back(a);
  return mesh;
}

// of the reference cell: 8 of a cube from -1 to 1, 1/6 of the corner of a cube
double volume_by_corners(const ReferenceCell& cell) { return cell.hexahedron() ? 8 : 1. / 6; }

template <class Check>
void for_every_cell(const Check& check) {
  for (const ReferenceCell& cell : reference_cells()) {
    CAPTURE(cell.n_nodes);
    check(cell);
  }
}

}  // namespace

TEST_CASE("every cell is listed once: by its type, its number of nodes, its name in VTK") {
  std::set<int> types, nodes, vtk;
  for_every_cell([&](const ReferenceCell& cell) {
    CHECK(types.insert(static_cast<int>(cell.type)).second);
    CHECK(nodes.insert(cell.n_nodes).second);
    CHECK(vtk.insert(cell.names.vtk).second);
    CHECK(&reference(cell.type) == &cell);
    CHECK(&reference(cell.n_nodes) == &cell);
    CHECK(nodes_per_cell(cell.type) == cell.n_nodes);
    CHECK(&alone(cell).cell() == &cell);
    CHECK(cell.n_nodes <= most_nodes);
    CHECK(cell.n_gauss <= most_gauss);
    int called = 0;
    with_cell(cell.n_nodes, [&](auto one) {
      ++called;
      CHECK(decltype(one)::type == cell.type);
      CHECK(decltype(one)::n_gauss == cell.n_gauss);
      CHECK(decltype(one)::n_dofs == 3 * cell.n_nodes);
    });
    CHECK(called == 1);
  });
  CHECK(reference_cells().size() == names(CellType{}).size());
  CHECK_THROWS_AS(reference(7), std::logic_error);
  CHECK_THROWS_AS(with_cell(7, [](auto) {}), std::logic_error);
}

TEST_CASE(
    "every cell: shape functions are 1 at their node, sum to 1, hold linear fields; gradients are their derivatives") {
  std::mt19937 random(3);
  for_every_cell([&](const ReferenceCell& cell) {
    REQUIRE(cell.node.size() == static_cast<std::size_t>(cell.n_nodes));
    for (int a = 0; a < cell.n_nodes; ++a)
      CHECK((cell.shape(cell.node[a]) - VecX(MatX::Identity(cell.n_nodes, cell.n_nodes).col(a)))
                .norm() < 1e-14);
    for (int k = 0; k < 20; ++k) {
      const Vec3 xi = inside(cell, random);
      const VecX N = cell.shape(xi), corners = cell.corner_shape(xi);
      CHECK(N.sum() == near(1, 1e-14));
      CHECK(corners.sum() == near(1, 1e-14));
      CHECK(corners.minCoeff() > -1e-15);
      Vec3 by_nodes = Vec3::Zero(), by_corners = Vec3::Zero();
      for (int a = 0; a < cell.n_nodes; ++a) by_nodes += N[a] * cell.node[a];
      for (int a = 0; a < cell.n_corners; ++a) by_corners += corners[a] * cell.node[a];
      CHECK((by_nodes - xi).norm() < 1e-14);
      CHECK((by_corners - xi).norm() < 1e-14);
      const double h = 1e-5;
      for (int i = 0; i < 3; ++i) {
        const VecX difference =
            (cell.shape(xi + h * Vec3::Unit(i)) - cell.shape(xi - h * Vec3::Unit(i))) / (2 * h);
        CHECK((cell.gradient(xi).col(i) - difference).norm() <
              1e-7);  // h^2 times third derivatives, and rounding over h
      }
    }
  });
}

TEST_CASE(
    "every cell: Gauss points give the volume of a cell under a linear map, and the integrals of its shape functions' gradients") {
  Mat3 F;
  F << 1.3, 0.2, -0.1, 0.3, 0.9, 0.2, 0.1, -0.2, 1.1;
  for_every_cell([&](const ReferenceCell& cell) {
    CHECK(quality(alone(cell, F)).volume == near(F.determinant() * volume_by_corners(cell), 1e-13));
    for (double w : cell.weight) CHECK(w > 0);
    // divergence theorem for every shape function: the integral of its gradient is that of N n over
    // the facets
    for (int a = 0; a < cell.n_nodes; ++a) {
      Vec3 over_cell = Vec3::Zero(), over_facets = Vec3::Zero();
      for (int g = 0; g < cell.n_gauss; ++g)
        over_cell += cell.weight[g] * cell.dN[g].row(a).transpose();
      for (int f = 0; f < cell.n_facets(); ++f) {
        const auto& n = cell.facet[f];
        const Vec3 outward = (cell.node[n[1]] - cell.node[n[0]])
                                 .cross(cell.node[n[2]] - cell.node[n[0]])
                                 .normalized();
        for (const FacetPoint& p : cell.facet_points[f])
          over_facets +=
              p.weight * p.along_1.cross(p.along_2).norm() * cell.shape(p.xi)[a] * outward;
      }
      CHECK((over_cell - over_facets).norm() < 1e-13);
    }
  });
}

TEST_CASE(
    "every cell: facets close it, corners counter-clockwise from outside, each edge in two of them, nodes where they should be") {
  for_every_cell([&](const ReferenceCell& cell) {
    Vec3 middle = Vec3::Zero();
    for (int c = 0; c < cell.n_corners; ++c) middle += cell.node[c] / cell.n_corners;
    std::set<std::pair<int, int>> sides;  // in the direction in which a facet goes round
    const Mesh mesh = alone(cell);
    for (int f = 0; f < cell.n_facets(); ++f) {
      const auto& n = cell.facet[f];
      const int corners = cell.facet_corners;
      const Vec3 outward =
          (cell.node[n[1]] - cell.node[n[0]]).cross(cell.node[n[2]] - cell.node[n[0]]);
      CHECK(outward.dot(cell.node[n[0]] - middle) > 0);
      for (int k = 0; k < corners; ++k) CHECK(n[k] < cell.n_corners);
      for (int node : n) CHECK(std::abs(outward.dot(cell.node[node] - cell.node[n[0]])) < 1e-15);
      for (int k = 0; k < corners; ++k) CHECK(sides.insert({n[k], n[(k + 1) % corners]}).second);
      if (cell.second_order())
        for (int k = 0; k < corners; ++k)
          CHECK(
              (cell.node[n[corners + k]] - (cell.node[n[k]] + cell.node[n[(k + 1) % corners]]) / 2)
                  .norm() < 1e-15);
      CHECK(static_cast<int>(facet_quads(mesh, {0, f}).size()) ==
            (cell.second_order() ? corners : 1));
    }
    for (const auto& [a, b] : sides) CHECK(sides.count({b, a}) == 1);
    CHECK(sides.size() == 2 * cell.edge.size());
    for (const auto& [a, b] : cell.edge) CHECK(sides.count({a, b}) == 1);
  });
}

TEST_CASE(
    "every cell: the hexahedra between its nodes fill it, and raising its corners gives its nodes") {
  for_every_cell([&](const ReferenceCell& cell) {
    const Mesh parts = between_nodes(alone(cell));
    double least = 1;
    for (int e = 0; e < parts.n_cells(); ++e)
      least = std::min(least, jacobian(parts, e, Vec3::Zero()).determinant());
    CHECK(least > 0);
    CHECK(quality(parts).volume == near(volume_by_corners(cell), 1e-13));
    std::vector<Vec3> X(cell.node.begin(), cell.node.begin() + cell.n_corners);
    std::vector<int> corners;
    for (int c = 0; c < cell.n_corners; ++c) corners.push_back(c);
    const Mesh one = raised(X, corners, cell.type);
    REQUIRE(one.n_nodes() == cell.n_nodes);
    for (int a = 0; a < cell.n_nodes; ++a)
      CHECK((one.X[one.cell(0)[a]] - cell.node[a]).norm() < 1e-15);
  });
}

TEST_CASE(
    "every cell: a linear field of the Gauss points is exact at the nodes; names elsewhere come with an order of nodes") {
  for_every_cell([&](const ReferenceCell& cell) {
    VecX at_gauss(cell.n_gauss), at_nodes(cell.n_nodes);
    const auto field = [](const Vec3& x) {
      return 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2];
    };
    for (int g = 0; g < cell.n_gauss; ++g) at_gauss[g] = field(cell.gauss[g]);
    for (int a = 0; a < cell.n_nodes; ++a) at_nodes[a] = field(cell.node[a]);
    CHECK((cell.at_nodes * at_gauss - at_nodes).norm() < 1e-12);
    for (int a = 0; a < cell.n_nodes; ++a) {
      const int g = cell.nearest_gauss[a];
      for (const Vec3& other : cell.gauss)
        CHECK((cell.gauss[g] - cell.node[a]).norm() <= (other - cell.node[a]).norm() + 1e-12);
    }
    std::set<int> order(cell.names.febio_order.begin(), cell.names.febio_order.end());
    CHECK((cell.names.febio == nullptr) == order.empty());
    if (cell.names.febio) CHECK(static_cast<int>(order.size()) == cell.n_nodes);
    if (cell.names.febio) CHECK((*order.begin() == 0 && *order.rbegin() == cell.n_nodes - 1));
  });
}
