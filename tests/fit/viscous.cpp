// Branches from homogeneous histories: what was put in is found again, whatever the test.
#include <doctest/doctest.h>

#include <random>

#include "core/base/error.hpp"
#include "identification/fit/fit.hpp"
#include "identification/fit/test_range.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// stretched to `to` within `ramp` seconds, held, and, as a cycle, back and stretched again
Test history(TestKind kind, double to, double ramp, double hold, bool cycle) {
  Test test;
  test.name = "history", test.kind = kind, test.measure = StressMeasure::nominal;
  const double rest = kind == TestKind::simple_shear ? 0 : 1;
  double t = 0;
  const auto point = [&](double share, double seconds) {
    t += seconds;
    test.time.push_back(t);
    test.first.push_back(rest + share * (to - rest));
    if (kind == TestKind::biaxial) test.second.push_back(1 + 0.6 * share * (to - rest));
    test.stress_x.push_back(0);
    if (kind == TestKind::biaxial || kind == TestKind::equibiaxial) test.stress_z.push_back(0);
  };
  point(0, 0);
  for (int i = 1; i <= 8; ++i) point(i / 8., ramp / 8);
  double step = ramp / 8;
  for (double held = 0; held < hold; held += step) point(1, step = std::min(1.4 * step, hold / 8));
  for (int i = 7; cycle && i >= 0; --i) point(i / 8., ramp / 8);
  for (int i = 1; cycle && i <= 8; ++i) point(i / 8., ramp / 8);
  return test;
}

// what the law says takes the place of what was measured
void measure(const Material& law, Test& test) {
  std::vector<double> s(test.values());
  REQUIRE(model_stress(law, test, Dilatation::incompressible, s.data()));
  test.stress_x.assign(s.begin(), s.begin() + static_cast<std::ptrdiff_t>(test.points()));
  test.stress_z.assign(s.begin() + static_cast<std::ptrdiff_t>(test.points()), s.end());
}

}  // namespace

TEST_CASE(
    "viscous fit: branches on decades and the elastic law together are found from exact histories of any kind") {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> gamma(0.05, 0.8);
  for (const TestKind kind : {TestKind::uniaxial, TestKind::equibiaxial, TestKind::biaxial,
                              TestKind::pure_shear, TestKind::simple_shear}) {
    Material law = test::stable(35, 1e-6);
    law.viscous = {{0.1, gamma(random), BranchOf::all},
                   {1, gamma(random), BranchOf::all},
                   {10, gamma(random), BranchOf::all}};
    FitProblem problem;
    problem.tests = {history(kind, kind == TestKind::simple_shear ? 0.4 : 1.3, 0.2, 60, true)};
    measure(law, problem.tests[0]);
    problem.law = law;
    problem.free = {{"matrix.yeoh.a1", 0.08, 0, 10},
                    {"viscous[0].gamma", 0.3, 0, 10},
                    {"viscous[1].gamma", 0.3, 0, 10},
                    {"viscous[2].gamma", 0.3, 0, 10}};
    FitOptions options;
    options.starts = 1;
    const FitResult found = fit(problem, options);
    CAPTURE(static_cast<int>(kind));
    CHECK(found.best.p[0] == near(0.05, 1e-6));
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(found.best.p[static_cast<Eigen::Index>(i) + 1] == near((*law.viscous)[i].gamma, 1e-6));
  }
}

TEST_CASE(
    "viscous fit: a branch that is not there gets nothing, a relaxation time that is asked for is found") {
  Material law = test::neo_hooke(0.2, 1e-6);
  law.viscous = {{0.3, 0.5, BranchOf::all}, {8, 0, BranchOf::all}};
  FitProblem problem;
  problem.tests = {history(TestKind::uniaxial, 1.2, 0.05, 20, false)};
  measure(law, problem.tests[0]);
  problem.law = law;
  problem.free = {{"matrix.neo_hooke.a1", 0.1, 0, 10},
                  {"viscous[0].tau", 1, 0.001, 100},
                  {"viscous[0].gamma", 0.2, 0, 10},
                  {"viscous[1].gamma", 0.2, 0, 10}};
  FitOptions options;
  options.starts = 3;
  const FitResult found = fit(problem, options);
  CHECK(found.best.p[0] == near(0.2, 1e-6));
  CHECK(found.best.p[1] == near(0.3, 1e-5));
  CHECK(found.best.p[2] == near(0.5, 1e-5));
  CHECK(std::abs(found.best.p[3]) < 1e-6);
}

TEST_CASE(
    "viscous fit: the stress of a slack direction is zero at every time, with fibres off the axes") {
  Material law = test::stable(25, 1e-6);
  law.viscous = {{0.2, 0.5, BranchOf::matrix}, {3, 0.7, BranchOf::fibres}};
  const auto a = specimen_fibres(law, 0);
  ViscousPoint point(law, a);
  for (const auto& one : {std::pair{1.1, 0.1}, {1.3, 0.5}, {1.2, 0.1}, {1.2, 4.}, {1.35, 0.01}}) {
    const PointMemory memory = point.begin(one.second);
    for (const OffAxisShear shear : {OffAxisShear::held, OffAxisShear::free}) {
      const PlaneState s = plane_state(law, a, TestKind::uniaxial, one.first, 1, shear, &memory);
      REQUIRE(s.converged);
      CHECK(std::abs(s.sigma(2, 2)) < 1e-10);
      CHECK(std::abs(s.sigma(1, 1)) < 1e-10);
      if (shear == OffAxisShear::free) CHECK(std::abs(s.sigma(0, 2)) < 1e-10);
      if (shear == OffAxisShear::free) point.accept(s.F);
    }
  }
}

TEST_CASE("viscous fit: times are read, and refused where they go back") {
  TestFormat format;
  format.strain_x = "strain", format.stress_x = "cauchy_stress_MPa", format.time = "t_s";
  const auto tests =
      parse_tests("t_s,strain,cauchy_stress_MPa\n0,0,0\n0.5,0.1,0.02\n0.5,0.2,0.05\n9,0.2,0.04\n",
                  "relax.csv", format);
  REQUIRE(tests.size() == 1);
  CHECK(tests[0].time == std::vector<double>{0, 0.5, 0.5, 9});
  try {
    parse_tests("t_s,strain,cauchy_stress_MPa\n0,0,0\n0.5,0.1,0.02\n0.4,0.2,0.05\n", "relax.csv",
                format);
    FAIL("accepted");
  } catch (const Failure& failure) {
    CHECK(std::string(failure.what()).find("relax.csv:4:1") != std::string::npos);
    CHECK(std::string(failure.what()).find("times that do not go back") != std::string::npos);
  }
}

TEST_CASE("viscous fit: what comes before the points that are compared is remembered") {
  Material law = test::stable(35, 1e-6);
  law.viscous = {{0.5, 0.4, BranchOf::all}, {20, 0.6, BranchOf::fibres}};
  Test whole = history(TestKind::biaxial, 1.25, 0.3, 10, true);
  measure(law, whole);
  const std::size_t n = whole.points() / 2;
  Test later = whole;
  compare_from(later, whole.time[n]);
  REQUIRE(later.points() == whole.points() - n);
  measure(law, later);
  for (std::size_t i = 0; i < later.points(); ++i) {
    CHECK(later.stress_x[i] == whole.stress_x[n + i]);
    CHECK(later.stress_z[i] == whole.stress_z[n + i]);
  }
  later.before = {};
  measure(law, later);
  CHECK(std::abs(later.stress_x[1] / whole.stress_x[n + 1] - 1) > 0.02);  // it did matter
}
