// Intervals of fits with parameters on a bound: closed form, limits, and how often they hold the
// truth.
#include "identification/statistics/within_bounds.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "core/base/random.hpp"
#include "identification/setup/fit_report.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

// Yeoh's law in tension to 1.4, a3 small beside what the noise leaves of it; stresses in units of
// their noise
FitProblem tension(double a3, std::uint64_t seed, std::vector<double>* true_values = nullptr) {
  FitProblem problem;
  problem.law.matrix = {Yeoh{0.05, 0.05, a3}};
  problem.law.volume = QuadraticVolume{1e-3};
  if (true_values) *true_values = {0.05, 0.05, a3};
  problem.free = {{"matrix.yeoh.a1", 0.05, 0.001, 1},
                  {"matrix.yeoh.a2", 0.05, 0, 1},
                  {"matrix.yeoh.a3", a3 + 0.01, 0, 1}};
  Test t;
  for (int i = 1; i <= 25; ++i) t.first.push_back(1 + 0.4 * i / 25);
  t.stress_x.resize(25);
  REQUIRE(model_stress(problem.law, t, Dilatation::incompressible, t.stress_x.data()));
  Random random(7, seed);
  for (double& s : t.stress_x) s += 4e-3 * random.normal();
  problem.tests = {t};
  return problem;
}

}  // namespace

TEST_CASE("the profile of a parameter in a box is that of an ellipse that is cut") {
  // |x|^2 - 2 c x y + |y|^2, both at 0, y >= 0
  const double c = 0.9;
  MatX J(2, 2);
  J << 1, -c, 0, std::sqrt(1 - c * c);
  VecX lower(2), upper(2), r = VecX::Zero(2);
  lower << -10, 0, upper << 10, 10;
  const auto x = box_profile(J, r, lower, upper, 0, 2), y = box_profile(J, r, lower, upper, 1, 2);
  CHECK(x[0] == near(-2, 1e-6));                        // y stays at 0
  CHECK(x[1] == near(2 / std::sqrt(1 - c * c), 1e-6));  // y follows
  CHECK(y[0] == 0);
  CHECK(y[1] == near(2 / std::sqrt(1 - c * c), 1e-6));
  // a bound that is pressed against lets go later: |x - c y|^2 + (1 - c^2) y^2 + 2 b y rises by
  // what presses
  VecX pressed(2);
  pressed << 0, 3;
  const auto late = box_profile(J, pressed, lower, upper, 0, 2);
  CHECK(late[1] < x[1]);
  CHECK(late[1] >= 2 - 1e-6);
  // what no data feel ends at the box
  MatX blind = J;
  blind.col(1).setZero();
  CHECK(box_profile(blind, r, lower, upper, 1, 2)[1] == 10);
  lower.setConstant(-inf), upper.setConstant(inf);
  CHECK(box_profile(J, r, lower, upper, 0, 2)[0] == near(-2 / std::sqrt(1 - c * c), 1e-6));
}

TEST_CASE(
    "away from bounds nothing is said, and far from their reach second moments are the covariance") {
  FitProblem problem = tension(0.5, 1);
  const FitResult inside = fit(problem, {.starts = 1});
  CHECK_FALSE(within_bounds(problem, inside));
  const FitRecord record = fit_record(problem, inside);
  problem.free.push_back(
      {"volume.quadratic.d", 1e-3, 1e-3, 1e-3});  // a box of no width: on its bound, known
  const FitResult held = fit(problem, {.starts = 1});
  const auto bounded = within_bounds(problem, held);
  REQUIRE(bounded);
  CHECK(bounded->low[3] == 1e-3);
  CHECK(bounded->high[3] == 1e-3);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto interval = interval_95(record.parameters[i]);
    CHECK(bounded->low[i] == near(interval[0], 1e-3));
    CHECK(bounded->high[i] == near(interval[1], 1e-3));
  }
}

TEST_CASE(
    "intervals hold the truth as often as they say where a parameter often ends on its bound") {
  constexpr int seeds = 300;
  for (const double a3 : {0.0, 0.01, 0.03}) {
    CAPTURE(a3);
    std::array<int, 3> held{}, taken_as_known{};
    int on_bound = 0;
    for (int seed = 0; seed < seeds; ++seed) {
      std::vector<double> truth;
      const FitProblem problem = tension(a3, static_cast<std::uint64_t>(seed), &truth);
      const FitResult found = fit(problem, {.starts = 1});
      REQUIRE(found.best.converged);
      on_bound += found.best.at_bound[2];
      const FitRecord record = fit_record(problem, found);
      for (std::size_t i = 0; i < 3; ++i) {
        const FittedParameter& p = record.parameters[i];
        const auto [low, high] = interval_95(p);
        held[i] += low <= truth[i] && truth[i] <= high;
        const auto k = static_cast<Eigen::Index>(i);
        const double error = p.factor * std::sqrt(found.covariance(k, k));
        if (std::isfinite(error)) taken_as_known[i] += std::abs(p.value - truth[i]) <= error;
      }
    }
    CHECK(on_bound > 0.03 * seeds);
    for (std::size_t i = 0; i < 3; ++i) {
      CAPTURE(i);
      CHECK(held[i] >= 0.92 * seeds);  // 95 % less two and a half standard deviations of 300 fits
    }
    MESSAGE("a3 ", a3, ": on its bound ", on_bound, ", held ", held[0], " ", held[1], " ", held[2],
            ", with a3 known ", taken_as_known[0], " ", taken_as_known[1]);
  }
}
