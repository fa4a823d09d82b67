// Derivatives of the mortar law and of its forces against finite differences.
#include "mechanics/mortar/mortar_linearisation.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "core/tensor/turn.hpp"
#include "mechanics/mortar/penetration.hpp"
#include "mortar/two_surfaces.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// no two of its edges lie on each other, and the upper one is covered in part
TwoSurfaces curved_surfaces() {
  return two_surfaces(
      {3, 2, -0.13, 2.9, 0.21, 1.94}, {4, 3, 0, 2.6, 0, 2},
      [](double x, double z) { return 0.02 + 0.06 * std::sin(x + 0.3) + 0.04 * std::cos(1.3 * z); },
      [](double x, double z) { return 0.07 * std::sin(1.1 * x + 0.2) - 0.03 * z * z; });
}

VecX wave(Eigen::Index n, double size, double phase) {
  VecX u(n);
  for (Eigen::Index i = 0; i < n; ++i) u[i] = size * std::sin(phase + 1.7 * static_cast<double>(i));
  return u;
}

std::vector<Vec3> some_reactions(std::size_t n) {
  std::vector<Vec3> r;
  for (std::size_t i = 0; i < n; ++i) {
    const double s = static_cast<double>(i);
    r.emplace_back(0.3 * std::sin(s), 1 + 0.2 * std::cos(s), 0.2 * std::sin(2 * s));
  }
  return r;
}

std::vector<int> every_column(Eigen::Index n) {
  std::vector<int> columns(static_cast<std::size_t>(n));
  std::iota(columns.begin(), columns.end(), 0);
  return columns;
}

// direction (3 n): the movement of all nodes by which gap, slip and forces are differentiated
void check_linearisation(const TwoSurfaces& s, const VecX& direction, double tolerance = 1e-7) {
  const Eigen::Index n = s.x.size();
  const VecX x0 = s.x - wave(n, 0.1, 0.4);
  std::vector<Vec3> reactions = some_reactions(s.contact.nodes.size());
  for (std::size_t i = 0; i < reactions.size(); ++i)
    reactions[i] = s.contact.within_mirrors(i, reactions[i]);
  const std::vector<char> all(s.contact.nodes.size(), 1);
  const auto nodes = mortar_nodes(s.contact, s.x);
  const MortarLaw law = mortar_law(nodes, all, s.x, x0, reactions);
  const auto rows = 3 * static_cast<Eigen::Index>(law.nodes.size());
  MortarMatrices matrices;
  add_mortar_matrices(s.contact, law, s.x, x0, every_column(n), 0, matrices);

  const double step = 1e-6;
  // the frame of the law turns by the smallest rotation with the normal
  const auto law_at = [&](double t) {
    const VecX x = s.x + t * direction;
    VecX q(rows);
    const auto moved = mortar_nodes(s.contact, x);
    REQUIRE(moved.size() == law.nodes.size());
    for (std::size_t p = 0; p < moved.size(); ++p) {
      const Vec3 n_old = law.nodes[p].normal;
      const Vec3 v = moved[p].average(x - x0);
      const auto row = 3 * static_cast<Eigen::Index>(p);
      q[row] = moved[p].gap();
      for (int k = 1; k < 3; ++k)
        q[row + k] = turn_with_normal(law.frames[p].col(k), n_old, moved[p].normal).dot(v);
    }
    return q;
  };
  const auto forces_at = [&](double t) {
    const VecX x = s.x + t * direction;
    const auto moved = mortar_nodes(s.contact, x);
    VecX f = VecX::Zero(n);
    for (const MortarNode& node : moved) {
      const auto i = static_cast<std::size_t>(node.candidate);
      const Vec3 r = turn_with_normal(reactions[i], law.nodes[i].normal, node.normal);
      for (const auto* side : {&node.own, &node.other})
        for (const Weight& w : *side)
          f.segment<3>(3 * static_cast<Eigen::Index>(w.node)) += w.of * r;
    }
    return f;
  };
  REQUIRE(law.nodes.size() == s.contact.nodes.size());
  const VecX by_differences = (law_at(step) - law_at(-step)) / (2 * step);
  const VecX change = matrices.L.matrix(rows, n) * direction;
  CHECK((change - by_differences).norm() < tolerance * by_differences.norm());
  const VecX forces = (forces_at(step) - forces_at(-step)) / (2 * step);
  CHECK((matrices.C.matrix(n, n) * direction - forces).norm() < tolerance * forces.norm());
}

TEST_CASE("forces and moments of two curved surfaces balance, whatever the reactions") {
  const TwoSurfaces s = curved_surfaces();
  std::vector<Vec3> reactions = some_reactions(s.contact.nodes.size());
  for (std::size_t i = 0; i < reactions.size(); ++i)
    reactions[i] = s.contact.within_mirrors(i, reactions[i]);
  VecX f = VecX::Zero(s.x.size());
  add_mortar_forces(mortar_nodes(s.contact, s.x), s.x, reactions, f);
  Vec3 sum = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  double size = 0;
  for (Eigen::Index i = 0; i < f.size(); i += 3) {
    const Vec3 force = f.segment<3>(i);
    const Vec3 place = s.x.segment<3>(i);
    sum += force;
    moment += cross(place, force);
    size += force.norm();
  }
  CHECK(size > 1);
  CHECK(sum.norm() < 1e-13 * size);
  CHECK(moment.norm() < 1e-13 * size);
}

TEST_CASE("nodes on a line take all of a moment but the part about their line") {
  VecX x(9);
  x << 0, 0, 0, /**/ -1, -0.5, 0, /**/ 1, -0.5, 0;
  MortarNode node;
  node.own = {{0, 1}};
  node.other = {{1, -0.5}, {2, -0.5}};
  node.jump = Vec3(0, 0.5, 0);
  const Vec3 r(0.3, -1, 0.7);
  Vec3 sum = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  for (const NodalForce& force : force_operator(node, x)) {
    const Vec3 f = force.per_reaction * r;
    sum += f;
    moment += cross(Vec3(x.segment<3>(3 * force.node)), f);
  }
  CHECK(sum.norm() < 1e-14);
  // The line is along x. Without a couple the moment of both sides is jump x r.
  const Vec3 without = cross(node.jump, r);
  CHECK(std::abs(without[2]) > 0.1);
  CHECK((moment - Vec3(without[0], 0, 0)).norm() < 1e-14);

  node.other = {{1, -1}};
  for (const NodalForce& force : force_operator(node, x)) CHECK(force.per_reaction.allFinite());
}

TEST_CASE("a gap that is linear over a flat surface is met at each node exactly") {
  const TwoSurfaces s = two_surfaces(
      {3, 3, 0.1, 1.9, 0.15, 1.8}, {5, 4, 0, 2, 0, 2}, [](double, double) { return 0.3; },
      [](double x, double z) { return 0.1 * x - 0.05 * z; });
  const auto nodes = mortar_nodes(s.contact, s.x);
  REQUIRE(nodes.size() == 16);
  for (const MortarNode& node : nodes) {
    const Vec3 x = s.x.segment<3>(3 * s.contact.nodes[static_cast<std::size_t>(node.candidate)]);
    CHECK(node.gap() == near(0.3 - (0.1 * x[0] - 0.05 * x[2]), 1e-12));
  }
}

TEST_CASE("weights do not jump where a facet slides off the edge of the other side") {
  double last = 0;
  double largest = 0;
  for (int i = 0; i <= 400; ++i) {
    const double moved = 0.0025 * i;
    const TwoSurfaces s = two_surfaces(
        {2, 1, moved, 2 + moved, 0, 1}, {1, 1, 0, 2, -1, 2}, [](double, double) { return 0.1; },
        [](double, double) { return 0.0; });
    double area = 0;
    double weighted = 0;
    for (const MortarNode& node : mortar_nodes(s.contact, s.x)) {
      area += node.area;
      weighted += node.area * node.average(s.x)[0] * node.candidate;
      for (const Weight& w : node.own) weighted += node.area * w.of * w.of;
    }
    CHECK(area == near(2 - moved, 1e-12, 1e-12));
    if (i > 0) largest = std::max(largest, std::abs(weighted - last));
    last = weighted;
  }
  CHECK(largest < 0.05);
}

}  // namespace

TEST_CASE("gap, slip and forces of two curved surfaces change as their linearisation says") {
  const TwoSurfaces s = curved_surfaces();
  check_linearisation(s, wave(s.x.size(), 1, 2.1));
}

TEST_CASE("linearisation of two curved surfaces that both end at a plane of symmetry") {
  TwoSurfaces s = two_surfaces(
      {3, 2, -0.13, 2.9, 0, 1.94}, {4, 3, 0, 2.6, 0, 2},
      [](double x, double z) { return 0.02 + 0.06 * std::sin(x + 0.3) + 0.04 * std::cos(1.3 * z); },
      [](double x, double z) { return 0.07 * std::sin(1.1 * x + 0.2) - 0.03 * z - 0.03 * z * z; });
  VecX direction = wave(s.x.size(), 1, 2.1);
  std::vector<char> held(static_cast<std::size_t>(s.x.size()), 0);
  for (Eigen::Index i = 2; i < s.x.size(); i += 3) {
    if (s.x[i] != 0) continue;
    direction[i] = 0;
    held[static_cast<std::size_t>(i)] = 1;
  }
  for (int node : s.contact.nodes)
    s.contact.mirrors.push_back({false, false, held[static_cast<std::size_t>(3 * node + 2)] != 0});
  // The edges of both sides stay on the plane: the facet in the middle of it is covered.
  const auto facets = mortar_facets(s.contact, s.x, false);
  CHECK(facets.at(1).D.sum() == near(facets.at(1).area, 1e-12));
  check_linearisation(s, direction);
}

TEST_CASE("linearisation of two surfaces that touch with all edges and corners on each other") {
  const auto height = [](double x, double z) {
    return 0.06 * std::sin(x + 0.3) + 0.04 * std::cos(1.3 * z);
  };
  const TwoSurfaces s = two_surfaces({2, 3, 0, 2, 0, 3}, {4, 5, -1, 3, -1, 4}, height, height);
  check_linearisation(s, wave(s.x.size(), 1, 2.1), 1e-5);
}

TEST_CASE("penetration of nodes that lie on the edges of facets is found") {
  const auto flat = [](double height) {
    return [height](double, double) {
      return height;
    };
  };
  const TwoSurfaces s = two_surfaces({1, 1, 0, 1, 0, 1}, {1, 1, 0, 1, 0, 1}, flat(-0.01), flat(0));
  for (int i = 0; i < 20; ++i) {
    const Mat3 turn = rotation(Vec3(1, 0.3, 0.5).normalized(), 0.1 + 0.3 * i);
    VecX x = s.x;
    for (Eigen::Index n = 0; n < x.size(); n += 3)
      x.segment<3>(n) = (turn * x.segment<3>(n)).eval() + Vec3(3, 2, 1);
    CHECK(penetration(s.contact, x) == near(0.01, 1e-9));
  }
}
