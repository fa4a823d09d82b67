// The law: S and D against differences of the energy, its symmetries, rest, the tension switch.
#include "material/material.hpp"

#include <doctest/doctest.h>
#include <Eigen/Geometry>

#include <random>

#include "material/catalogue.hpp"
#include "tensor/kinematics.hpp"
#include "tensor/stress.hpp"

using namespace langer;

namespace {

Mat3 random_gradient(std::mt19937& rng, double size) {
  std::uniform_real_distribution<double> x(-size, size);
  Mat3 H;
  for (int i = 0; i < 9; ++i) H(i / 3, i % 3) = x(rng);
  return H;
}

Mat3 random_rotation(std::mt19937& rng) {
  std::normal_distribution<double> x;
  return Eigen::Quaterniond(x(rng), x(rng), x(rng), x(rng)).normalized().toRotationMatrix();
}

// any fibre close to its switch makes a difference quotient across the kink of D: such samples are skipped
bool near_switch(const std::vector<Vec3>& a, const Mat3& C) {
  const double m = std::cbrt(1 / (1 + determinant_minus_1(C - Mat3::Identity())));
  for (const Vec3& d : a)
    for (double I4 : {d.dot(C * d), m * d.dot(C * d)})
      if (std::abs(I4 - 1) < 0.01) return true;
  return false;
}

}  // namespace

TEST_CASE("S is the derivative of W and D the symmetric derivative of S, for every law") {
  std::mt19937 rng(21);
  for (const NamedMaterial& named : catalogue())
    for (int trial = 0; trial < 30; ++trial) {
      CAPTURE(named.name);
      CAPTURE(trial);
      const Mat3 C = right_cauchy_green(deformation_gradient(random_gradient(rng, 0.25)));
      const Mat3 frame = random_rotation(rng);
      const auto a = fibre_directions(named.material, frame);
      if (near_switch(a, C)) continue;
      const Response r = response(named.material, C, a);
      CHECK((r.D - r.D.transpose()).norm() <= 1e-14 * r.D.norm());
      // fourth-order central differences: h^4/30 times a fifth derivative, plus eps W/h
      const double h = 1e-3;
      Vec6 S;
      Mat6 D;
      for (int q = 0; q < 6; ++q) {
        Vec6 step = Vec6::Zero();  // of E, so that C changes by twice as much
        step[q] = q < 3 ? h : h / 2;
        const auto at = [&](double n) { return response(named.material, C + 2 * n * tensor(step), a); };
        const Response p1 = at(1), m1 = at(-1), p2 = at(2), m2 = at(-2);
        S[q] = (8 * (p1.W - m1.W) - (p2.W - m2.W)) / (12 * h);
        D.col(q) = (8 * (p1.S - m1.S) - (p2.S - m2.S)) / (12 * h);
      }
      CHECK((S - r.S).norm() <= 1e-7 * r.S.norm());
      CHECK((D - r.D).norm() <= 1e-7 * r.D.norm());
    }
}
