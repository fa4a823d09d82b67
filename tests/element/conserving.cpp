// The force of an increment that keeps energy and angular momentum.
#include "mechanics/element/conserving_solid.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <string>

#include "mechanics/element/solid.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

struct Cell {
  int n = 0;
  Formulation formulation = Formulation::mean_dilatation;
};
const Cell cells[] = {{8, Formulation::mean_dilatation},
                      {8, Formulation::displacement},
                      {27, Formulation::linear_dilatation},
                      {15, Formulation::linear_dilatation},
                      {15, Formulation::displacement}};

std::vector<Material> laws() {
  Material ogden;
  ogden.matrix = {Ogden{0.4, 3}};
  ogden.volume = LogarithmicVolume{0.1};
  Material mixed = test::stable(30, 0.1);
  mixed.volume = SimoTaylorVolume{0.1};
  return {test::neo_hooke(0.1, 1e-2), test::stable(30, 0.1), ogden, mixed};
}

ElementNodes random_nodes(int n, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-size, size);
  ElementNodes q(n, 3);
  for (double& value : q.reshaped()) value = u(random);
  return q;
}

// A cell of edges of about 0.5 with nodes out of place.
ElementNodes positions(int n) {
  const auto& node = reference(n).node;
  ElementNodes X = random_nodes(n, n == 8 ? 0.1 : 0.005, 5);
  for (int a = 0; a < n; ++a) X.row(a) += 0.5 * node[a].transpose();
  return X;
}

// Movements that also turn the cell: u = R (X + strain) - X.
ElementNodes turned(const ElementNodes& X, double angle, double size, unsigned seed) {
  const auto n = static_cast<int>(X.rows());
  const Mat3 R = Eigen::AngleAxisd(angle, Vec3(1, 2, -2).normalized()).toRotationMatrix();
  const double most = n == 8 ? size : 0.1 * size;
  const Mat3 stretch =
      Mat3::Identity() + size * (Mat3() << 1, 0.4, 0, 0.4, -0.7, 0.3, 0, 0.3, -0.2).finished();
  return (X * stretch.transpose() + random_nodes(n, most, seed)) * R.transpose() - X;
}

struct TimeStep {
  ElementNodes X, u0, u1;
  ElementGeometry geometry;
  std::vector<Vec3> a;
  Material material;
  Cell cell;
  double local = 0;

  ConservingElement at(const ElementNodes& end, bool with_tangent = false) const {
    ConservingElement out;
    REQUIRE(conserving_solid(cell.formulation, material, local, geometry, a, u0, end, nullptr,
                             with_tangent, out));
    return out;
  }
  SolidElement state(const ElementNodes& u, bool with_tangent = false) const {
    SolidElement out;
    REQUIRE(solid(cell.formulation, material, local, geometry, a, u, nullptr, with_tangent, out));
    return out;
  }
};

TimeStep time_step(const Cell& cell, const Material& material, double angle, double strain) {
  TimeStep out;
  out.cell = cell;
  out.material = material;
  out.X = positions(cell.n);
  out.geometry = element_geometry(out.X);
  out.a = fibre_directions(material);
  out.local = test::local_modulus(cell.formulation, material);
  out.u0 = turned(out.X, 0.3, 0.05, 1);
  out.u1 = turned(out.X, 0.3 + angle, 0.05 + strain, strain == 0 ? 1 : 2);
  return out;
}

VecX column(const ElementNodes& q) {
  VecX out(3 * q.rows());
  for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = q(i / 3, i % 3);
  return out;
}

}  // namespace

TEST_CASE(
    "over an increment the force does as much work as the energy changes, and has no moment") {
  for (const Material& material : laws()) {
    for (const Cell& cell : cells) {
      for (double strain : {1e-7, 1e-3, 0.02, 0.2}) {
        const TimeStep of = time_step(cell, material, 0.2, strain);
        const ConservingElement at = of.at(of.u1);
        const double change = of.state(of.u1).W - of.state(of.u0).W;
        const VecX du = column(of.u1 - of.u0);
        // Rounding of energies that are differences of terms as large as the moduli.
        const double size = 1e-12 * of.geometry.V * bulk_modulus(material);
        CHECK(at.f.dot(du) == near(change, 1e-10, size));
        CHECK(at.W == near(of.state(of.u1).W, 1e-12, size));
        Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
        for (int i = 0; i < cell.n; ++i) {
          const Vec3 x = (of.X + 0.5 * (of.u0 + of.u1)).row(i).transpose();
          sum += at.f.segment<3>(3 * i);
          moment += x.cross(Vec3(at.f.segment<3>(3 * i)));
        }
        CHECK(sum.norm() < 1e-13 * (1 + at.f.norm()));
        CHECK(moment.norm() < 1e-13 * (1 + at.f.norm()));
      }
    }
  }
}

TEST_CASE("the tangent of an increment is the derivative of its force") {
  for (const Material& material : laws()) {
    for (const Cell& cell : cells) {
      if (cell.n == 27 && !material.fibres.empty()) continue;  // long, and nothing new
      for (double strain : {0., 1e-3, 0.2}) {
        const TimeStep of = time_step(cell, material, 0.2, strain);
        const ConservingElement at = of.at(of.u1, true);
        const double h = 3e-6;
        double largest = 0;
        for (int j = 0; j < 3 * cell.n; ++j) {
          ElementNodes up = of.u1;
          ElementNodes down = of.u1;
          up(j / 3, j % 3) += 2 * h;  // the unknown is the middle of the increment
          down(j / 3, j % 3) -= 2 * h;
          const VecX change = (of.at(up).f - of.at(down).f) / (2 * h);
          largest = std::max(largest, (change - at.K.col(j)).lpNorm<Eigen::Infinity>());
        }
        CHECK(largest < 1e-7 * at.K.lpNorm<Eigen::Infinity>());
      }
    }
  }
}

TEST_CASE("over a vanishing increment force and tangent are those of the state") {
  for (const Material& material : laws()) {
    for (const Cell& cell : cells) {
      for (double size : {0., 1e-12, 1e-9}) {
        TimeStep of = time_step(cell, material, 0, 0);
        of.u1 = of.u0 + random_nodes(cell.n, size, 3);
        const ConservingElement at = of.at(of.u1, true);
        const SolidElement state = of.state(of.u0, true);
        const double stiffness = state.K.lpNorm<Eigen::Infinity>();
        CHECK((at.f - state.f).lpNorm<Eigen::Infinity>() < (10 * size + 1e-14) * stiffness);
        CHECK((at.K - state.K).lpNorm<Eigen::Infinity>() < 1e-6 * stiffness);
      }
    }
  }
}

TEST_CASE("a cell at rest that turns by any angle has no force") {
  for (double angle : {0.1, 1., 2.5}) {
    TimeStep of = time_step(cells[0], test::neo_hooke(0.1, 1e-6), angle, 0);
    of.u0.setZero();
    of.u1 = turned(of.X, angle, 0, 1);
    CHECK(of.at(of.u1).f.norm() < 1e-14 * bulk_modulus(of.material));
  }
}
