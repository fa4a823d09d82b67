#include <doctest/doctest.h>

#include <cmath>

#include "core/base/random.hpp"
#include "identification/fit/prior.hpp"
#include "identification/posterior/posterior.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// A neo-Hookean matrix with HGO fibres along x, stretched along both axes, with noise.
FitProblem noisy_problem() {
  FitProblem problem;
  problem.law.matrix = {Yeoh{0.02, 0.01, 0}};
  problem.law.fibres = {{HgoFibre{0.05, 1}, 0}};
  problem.free = {{"matrix.yeoh.a1", 0.02, 0, 1}, {"fibres[0].hgo.c1", 0.05, 0, 1}};
  Random random(3);
  for (const double share : {1., 0.4}) {
    Test test;
    test.name = "biaxial";
    test.kind = TestKind::biaxial;
    test.measure = StressMeasure::nominal;
    for (int i = 1; i <= 12; ++i) {
      test.first.push_back(1 + 0.02 * i);
      test.second.push_back(1 + 0.02 * i * share);
    }
    test.stress_x.assign(12, 0);
    test.stress_z.assign(12, 0);
    std::vector<double> stress(24);
    REQUIRE(model_stress(problem.law, test, Dilatation::incompressible, stress.data()));
    for (std::size_t i = 0; i < 12; ++i) {
      test.stress_x[i] = stress[i] + 0.0008 * random.normal();
      test.stress_z[i] = stress[12 + i] + 0.0008 * random.normal();
    }
    problem.tests.push_back(test);
  }
  return problem;
}

}  // namespace

TEST_CASE("quantiles of a posterior are the intervals of Student where the model is straight") {
  const FitProblem problem = noisy_problem();
  const FitResult found = fit(problem, {2, 1, {}});
  REQUIRE(found.best.converged);
  PosteriorConfig config;
  config.samples = 4000;
  const Posterior one = posterior(problem, found, config, 1);
  CHECK(one.divergences == 0);
  RecordTable table = one.table;
  for (std::size_t j = 0; j < 2; ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    CHECK(one.r_hat[j] < 1.01);
    CHECK(one.effective[j] > 1500);
    const double error = std::sqrt(found.covariance(at, at));
    // Student's 2.0154 for 44 degrees of freedom; quantiles of so many samples scatter by 5 %
    CHECK(table.column("median").values[j] == near(found.best.p[at], 0, 0.08 * error));
    CHECK(table.column("lower_95").values[j] ==
          near(found.best.p[at] - 2.0154 * error, 0, 0.2 * error));
    CHECK(table.column("upper_95").values[j] ==
          near(found.best.p[at] + 2.0154 * error, 0, 0.2 * error));
  }
  SUBCASE("and do not depend on threads") {
    config.samples = 200;
    const Posterior serial = posterior(problem, found, config, 1);
    const Posterior parallel = posterior(problem, found, config, 2);
    CHECK(serial.samples == parallel.samples);
  }
}

TEST_CASE("a prior counts as one measurement with its deviation") {
  FitProblem problem = noisy_problem();
  weigh_by_noise(problem, {2, 1, {}});
  const FitResult without = fit(problem, {2, 1, {}});
  const double error = std::sqrt(without.covariance(0, 0));
  CHECK(without.noise.total() == near(1, 1e-6));
  // a prior as precise as the data, two errors away: the estimate moves by one, its variance halves
  Prior prior;
  prior.number = 0;
  prior.centre = without.best.p[0] + 2 * error;
  prior.deviation = error;
  problem.further = with_priors({prior}, {});
  const FitResult with = fit(problem, {2, 1, {}});
  REQUIRE(with.best.converged);
  CHECK(with.best.p[0] == near(without.best.p[0] + error, 0, 0.01 * error));
  CHECK(with.covariance(0, 0) == near(error * error / 2, 0.1));

  SUBCASE("a lognormal one of the logarithm") {
    Prior other;
    other.number = 1;
    other.logarithm = true;
    other.centre = std::log(0.08);
    other.deviation = 1e-4;
    problem.further = with_priors({other}, {});
    CHECK(fit(problem, {2, 1, {}}).best.p[1] == near(0.08, 1e-2));
  }
}
