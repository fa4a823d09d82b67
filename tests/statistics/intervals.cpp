// 95 % intervals where the model is not straight over them: they are those of the profile, they
// hold what they claim, and they stay in the box.
#include "identification/statistics/intervals.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "identification/setup/fit_report.hpp"
#include "support/correlated.hpp"

using namespace langer;

namespace {

// protocols of an HGO-Yeoh law at an angle, with noise of a part of the largest stress
FitProblem at_angle(double angle, double part, std::uint64_t seed) {
  FitProblem q = test::protocols(15);
  q.law.fibres[0].alpha_deg = angle;
  q.free[4].start = angle;
  for (Test& t : q.tests) {
    std::vector<double> s(t.values());
    REQUIRE(model_stress(q.law, t, Dilatation::incompressible, s.data()));
    const auto middle = s.begin() + static_cast<std::ptrdiff_t>(t.points());
    t.stress_x.assign(s.begin(), middle);
    t.stress_z.assign(middle, s.end());
  }
  return test::noisy(q, part * test::largest_of(q), 0, seed);
}

std::vector<Interval> first_order(const FitRecord& record) {
  std::vector<Interval> first;
  for (const FittedParameter& p : record.parameters) {
    const double half = p.factor * p.standard_error;
    first.push_back({p.value - half, p.value + half});
  }
  return first;
}

}  // namespace

TEST_CASE("a straight model keeps its intervals to first order") {
  // moduli alone: the stress is linear in them
  FitProblem q = at_angle(30, 0.01, 1);
  q.free.resize(3);
  const FitResult f = fit(q, {.starts = 1});
  const FitRecord record = fit_record(q, f);
  for (const FittedParameter& p : record.parameters) CHECK(std::isnan(p.low));
  for (const Interval& one : intervals_95(q, f, first_order(record))) CHECK_FALSE(one.by_profile);
}

TEST_CASE("near a symmetry the interval of an angle holds the truth as often as it claims") {
  constexpr int seeds = 30;
  for (double angle : {86., 88., 90.}) {
    CAPTURE(angle);
    int held = 0;
    int by_profile = 0;
    for (int seed = 0; seed < seeds; ++seed) {
      const FitProblem q = at_angle(angle, 0.01, static_cast<std::uint64_t>(seed));
      const FitResult f = fit(q, {.starts = 1});
      REQUIRE(f.best.converged);
      const FitRecord record = fit_record(q, f);
      const auto [low, high] = interval_95(record.parameters[4]);
      REQUIRE(std::isfinite(low));
      REQUIRE(std::isfinite(high));
      by_profile += std::isfinite(record.parameters[4].low) ? 1 : 0;
      bool holds = false;
      for (double turns : {-180., 0., 180.})
        holds = holds || (low <= angle + turns && angle + turns <= high);
      held += holds ? 1 : 0;
    }
    CHECK(by_profile > seeds / 2);
    CHECK(held >= 25);  // 28.5 less three binomial standard deviations
  }
}

TEST_CASE("no interval leaves the box") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    CAPTURE(seed);
    FitProblem q = at_angle(30, 0.03, seed);
    q.law = {{Yeoh{0.05, 0.05, 0.01}}, {}, q.law.volume};
    q.free = {{"matrix.yeoh.a1", 0.05, 0, 1},
              {"matrix.yeoh.a2", 0.05, 0, 1},
              {"matrix.yeoh.a3", 0.01, 0, 10}};
    const FitResult f = fit(q, {.starts = 1});
    REQUIRE(f.best.converged);
    for (const FittedParameter& p : fit_record(q, f).parameters) {
      const auto [low, high] = interval_95(p);
      CHECK(low >= p.lower);
      CHECK(high <= p.upper);
      CHECK(low <= p.value);
      CHECK(high >= p.value);
    }
  }
}
