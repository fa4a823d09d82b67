// Forces on facets: consistent with the shape functions, and a pressure's tangent with its force.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "mechanics/element/surface.hpp"
#include "mechanics/mesh/reference.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// nodes of a cell of about 1 mm, moved at random
ElementNodes random_cell(const ReferenceCell& cell, std::mt19937& random, double amount) {
  std::uniform_real_distribution<double> u(-amount, amount);
  ElementNodes x(cell.n_nodes, 3);
  for (int a = 0; a < cell.n_nodes; ++a)
    for (int k = 0; k < 3; ++k) x(a, k) = cell.node[a][k] + u(random);
  return x;
}

// df/dx by central differences
MatX differences(const ReferenceCell& cell, int facet, const ElementNodes& x) {
  const double h = 1e-5;
  MatX K(3 * cell.n_nodes, 3 * cell.n_nodes);
  for (int b = 0; b < cell.n_nodes; ++b)
    for (int k = 0; k < 3; ++k) {
      ElementNodes more = x, less = x;
      more(b, k) += h, less(b, k) -= h;
      const ElementNodes df =
          (follower_pressure(cell, facet, more) - follower_pressure(cell, facet, less)) / (2 * h);
      for (int a = 0; a < cell.n_nodes; ++a)
        for (int i = 0; i < 3; ++i) K(3 * a + i, 3 * b + k) = df(a, i);
    }
  return K;
}

}  // namespace

TEST_CASE(
    "the stiffness of a following pressure is the symmetric part of its force's differences, and the rest is skew, 1e-7") {
  std::mt19937 random(5);
  for (const ReferenceCell& cell : reference_cells())
    for (int draw = 0; draw < 5; ++draw) {
      const ElementNodes x = random_cell(cell, random, 0.15);
      for (int f = 0; f < cell.n_facets(); ++f) {
        const MatX K = differences(cell, f, x), symmetric = 0.5 * (K + K.transpose()),
                   skew = K - symmetric, ours = follower_stiffness(cell, f, x);
        CHECK((ours - symmetric).lpNorm<Eigen::Infinity>() <
              1e-7 * symmetric.lpNorm<Eigen::Infinity>());
        CHECK((ours - K).lpNorm<Eigen::Infinity>() >
              1e-3 * K.lpNorm<Eigen::Infinity>());  // the rim is not symmetric
        const ElementNodes dx = random_cell(cell, random, 1),
                           change = follower_skew_change(cell, f, x, dx);
        for (int a = 0; a < cell.n_nodes; ++a)
          for (int i = 0; i < 3; ++i) {
            double sum = 0;
            for (int b = 0; b < cell.n_nodes; ++b)
              sum += skew.block<1, 3>(3 * a + i, 3 * b).dot(dx.row(b));
            CHECK(std::abs(change(a, i) - sum) < 1e-7 * change.lpNorm<Eigen::Infinity>());
          }
      }
    }
}

TEST_CASE(
    "on a closed surface a following pressure has a symmetric tangent, no resultant, and does the work p dV") {
  std::mt19937 random(6);
  for (const ReferenceCell& cell : reference_cells())
    for (int draw = 0; draw < 5; ++draw) {
      ElementNodes x = random_cell(cell, random, 0.1);
      if (!cell.hexahedron()) {  // its Gauss points are exact for straight sides
        const Mat3 map = Mat3::Identity() + 0.3 * Mat3::Random();
        for (int a = 0; a < cell.n_nodes; ++a) x.row(a) = (map * cell.node[a]).transpose();
      }
      MatX K = MatX::Zero(3 * cell.n_nodes, 3 * cell.n_nodes), ours = K;
      ElementNodes f = ElementNodes::Zero(cell.n_nodes, 3);
      for (int facet = 0; facet < cell.n_facets(); ++facet) {
        K += differences(cell, facet, x), ours += follower_stiffness(cell, facet, x);
        f += follower_pressure(cell, facet, x);
      }
      CHECK((K - K.transpose()).lpNorm<Eigen::Infinity>() < 1e-7 * K.lpNorm<Eigen::Infinity>());
      CHECK((K - ours).lpNorm<Eigen::Infinity>() < 1e-7 * K.lpNorm<Eigen::Infinity>());
      CHECK(f.colwise().sum().norm() < 1e-12);
      double V = 0;
      for (std::size_t g = 0; g < cell.weight.size(); ++g)
        V += cell.weight[g] * Mat3(x.transpose() * cell.dN[g]).determinant();
      CHECK(f.cwiseProduct(x).sum() ==
            near(-3 * V, 1e-10));  // pushes inwards: dV = 3 V under u = x
    }
}

TEST_CASE(
    "a dead traction on a flat facet has the shares 1/4, 1/36 4/36 16/36, and 1/20 2/15 9/20") {
  for (const ReferenceCell& cell : reference_cells()) {
    ElementNodes X(cell.n_nodes, 3);
    for (int a = 0; a < cell.n_nodes; ++a)
      X.row(a) = (Vec3(2, 0.5, 3).cwiseProduct(cell.node[a])).transpose();
    const Vec3 traction(0.3, -0.2, 0.5);
    for (int facet = 0; facet < cell.n_facets(); ++facet) {
      const ElementNodes f = dead_traction(cell, facet, X, traction);
      const Vec3 sum = f.colwise().sum().transpose();
      const auto& nodes = cell.facet[facet];
      const std::vector<double> share = !cell.second_order() ? std::vector{0.25}
                                        : cell.hexahedron()
                                            ? std::vector{1. / 36, 4. / 36, 16. / 36}
                                            : std::vector{1. / 20, 2. / 15, 9. / 20};
      const Vec3 e1 = X.row(nodes[1]) - X.row(nodes[0]),
                 e2 = X.row(nodes[static_cast<std::size_t>(cell.facet_corners) - 1]) -
                      X.row(nodes[0]);
      const double area = e1.cross(e2).norm() * (cell.hexahedron() ? 1 : 0.5);
      CHECK((sum - area * traction).norm() < 1e-12 * area);
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        const std::size_t n = static_cast<std::size_t>(cell.facet_corners), kind = k < n       ? 0
                                                                                   : k < 2 * n ? 1
                                                                                               : 2;
        CHECK((Vec3(f.row(nodes[k]).transpose()) - share[kind] * area * traction).norm() <
              1e-12 * area);
      }
    }
  }
}
