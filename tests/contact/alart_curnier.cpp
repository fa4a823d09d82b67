// The contact law as a root: its zeros are the law's states, its derivative that of differences, in
// each of the three states.
#include "mechanics/contact/alart_curnier.hpp"

#include <doctest/doctest.h>

#include <random>

using namespace langer;

TEST_CASE(
    "the change of Alart and Curnier's function is its derivative, in each state and across all unknowns") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  int met[3] = {0, 0, 0};
  for (int trial = 0; trial < 1000; ++trial) {
    // reactions that depend on the unknowns as those of a supported body do: r = A s, x = W s
    const Mat3 A = Mat3::NullaryExpr([&] { return u(random); }),
               W = Mat3::NullaryExpr([&] { return u(random); });
    const Vec3 s = Vec3::NullaryExpr([&] { return u(random); });
    const double rho = 0.5 + std::abs(u(random)), mu = 0.5 * (1 + u(random)), h = 1e-6;
    const auto at = [&](const Vec3& a) {
      return AlartCurnier(A * a, W * a, rho, mu);
    };
    const AlartCurnier law = at(s);
    const Mat3 dF = law.change(A, Mat3(rho * W));
    bool smooth = true;  // no other state, nor the kink at the disc's centre, nearby
    Mat3 difference;
    for (int k = 0; k < 3; ++k) {
      const Vec3 ds = 1e-3 * Vec3::Unit(k);
      smooth = smooth && at(s + ds).status == law.status && at(s - ds).status == law.status;
      difference.col(k) = (at(s + h * Vec3::Unit(k)).F - at(s - h * Vec3::Unit(k)).F) / (2 * h);
    }
    const Vec3 tau = A * s - rho * (W * s);
    if (!smooth || tau.tail<2>().norm() < 0.1) continue;
    ++met[static_cast<int>(law.status)];
    CHECK((dF - difference).norm() <= 1e-7 * (A.norm() + rho * W.norm()));
  }
  for (int state : met) CHECK(state > 20);
}
