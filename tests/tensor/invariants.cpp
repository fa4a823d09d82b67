// Invariants of C: derivatives against central differences, and frame indifference.
#include "core/tensor/invariants.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <random>

#include "core/tensor/kinematics.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

Mat3 random_matrix(std::mt19937& rng, double size) {
  std::uniform_real_distribution<double> x(-size, size);
  Mat3 A;
  for (int i = 0; i < 9; ++i) A(i / 3, i % 3) = x(rng);
  return A;
}

struct Candidate {
  const char* name;
  std::function<double(const Invariants&)> value;
  std::function<Vec6(const Invariants&)> gradient;
  std::function<Mat6(const Invariants&)> hessian;
};

std::vector<Candidate> candidates() {
  const Vec6 M = structural_tensor(Vec3(0.6, 0, 0.8));
  return {
      {"I1_bar", [](auto& v) { return linear_bar(v, identity6()); },
       [](auto& v) { return dlinear_bar_dC(v, identity6()); },
       [](auto& v) {
         return d2linear_bar_dC2(v, identity6(), inverse_product(v));
       }},
      {"I4_bar", [M](auto& v) { return linear_bar(v, M); },
       [M](auto& v) { return dlinear_bar_dC(v, M); },
       [M](auto& v) {
         return d2linear_bar_dC2(v, M, inverse_product(v));
       }},
      {"I2_bar", [](auto& v) { return I2_bar(v); }, [](auto& v) { return dI2_bar_dC(v); },
       [](auto& v) {
         return d2I2_bar_dC2(v, inverse_product(v));
       }},
      {"J", [](auto& v) { return std::sqrt(v.I3); },
       [](auto& v) { return dJ_dC(v, std::sqrt(v.I3)); },
       [](auto& v) {
         return d2J_dC2(v, std::sqrt(v.I3), inverse_product(v));
       }},
  };
}

}  // namespace

TEST_CASE("gradient and Hessian of every invariant agree with central differences") {
  std::mt19937 rng(11);
  // error of a central difference: h^2/6 times a third derivative of order 10, plus eps/h
  const double h = 1e-5, tolerance = 1e-8;
  for (int trial = 0; trial < 20; ++trial) {
    const Mat3 F = Mat3::Identity() + random_matrix(rng, 0.3);
    const Mat3 C = right_cauchy_green(F);
    for (const Candidate& c : candidates()) {
      CAPTURE(c.name);
      CAPTURE(trial);
      const Invariants v = invariants(C);
      const Vec6 g = c.gradient(v);
      const Mat6 H = c.hessian(v);
      CHECK((H - H.transpose()).norm() <= 1e-14 * H.norm());
      for (int q = 0; q < 6; ++q) {
        Vec6 step = Vec6::Zero();
        step[q] = q < 3 ? h : h / 2;  // symmetric change of C with A:dC = A_q h
        const Invariants plus = invariants(C + tensor(step)), minus = invariants(C - tensor(step));
        CHECK(std::abs((c.value(plus) - c.value(minus)) / (2 * h) - g[q]) <=
              tolerance * std::max(1., g.norm()));
        const Vec6 dg = (c.gradient(plus) - c.gradient(minus)) / (2 * h);
        CHECK((dg - H.col(q)).norm() <= tolerance * std::max(1., H.norm()));
      }
    }
  }
}

TEST_CASE("volumetric change leaves the barred invariants alone") {
  std::mt19937 rng(12);
  const Mat3 C = right_cauchy_green(Mat3::Identity() + random_matrix(rng, 0.3));
  const Vec6 M = structural_tensor(Vec3(0, 0.6, 0.8));
  for (double scale : {0.5, 1.7}) {
    const Invariants v = invariants(C), w = invariants(scale * C);
    CHECK(linear_bar(w, identity6()) == near(linear_bar(v, identity6()), 1e-14));
    CHECK(linear_bar(w, M) == near(linear_bar(v, M), 1e-14));
    CHECK(I2_bar(w) == near(I2_bar(v), 1e-14));
  }
}

TEST_CASE("the barred invariants of a rotation are 3, 3 and 1, and their gradients have no trace") {
  const Invariants v = invariants(Mat3::Identity());
  CHECK(linear_bar(v, identity6()) == 3);
  CHECK(I2_bar(v) == 3);
  const Vec6 M = structural_tensor(Vec3(0.6, 0, 0.8));
  CHECK(linear_bar(v, M) == near(1, 1e-15));
  CHECK(dlinear_bar_dC(v, identity6()).norm() <= 1e-15);
  CHECK(std::abs(dlinear_bar_dC(v, M).head<3>().sum()) <= 1e-15);
}

TEST_CASE("the symmetric product is what its index form says") {
  std::mt19937 rng(13);
  const Mat3 C = right_cauchy_green(random_matrix(rng, 1));
  const Mat6 P = symmetric_product(C);
  for (int p = 0; p < 6; ++p)
    for (int q = 0; q < 6; ++q) {
      const int i = voigt_i[p], j = voigt_j[p], k = voigt_i[q], l = voigt_j[q];
      CHECK(P(p, q) == near(0.5 * (C(i, k) * C(j, l) + C(i, l) * C(j, k)), 1e-15));
    }
}
