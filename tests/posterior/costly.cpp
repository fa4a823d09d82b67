// Posteriors whose tests are costly: polynomials in their place, and what remains exact.
#include "identification/posterior/costly_posterior.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "core/tensor/dense.hpp"
#include "identification/fit/prior.hpp"
#include "support/near.hpp"

using namespace langer;

namespace costly_posterior_tests {

namespace {

// A curve that saturates, a (1 - exp(-b x)) + bend max(0, x - b), measured with noise.
class Curve : public FurtherTests {
 public:
  explicit Curve(double bend) : bend_(bend) {
    Random random(5);
    VecX values;
    const VecX truth{{2, 0.8}};
    measured_ = VecX::Zero(points);
    weight_ = VecX::Constant(points, 1 / 0.1);
    REQUIRE(model(truth, values));
    for (Eigen::Index i = 0; i < points; ++i) measured_[i] = values[i] + 0.1 * random.normal();
    calls = 0;
  }
  const VecX& measured() const override { return measured_; }
  const VecX& weight() const override { return weight_; }
  const std::vector<Eigen::Index>& curves() const override { return curves_; }
  bool model(const VecX& p, VecX& values) override {
    ++calls;
    if (p[1] > no_model_above) return false;
    values.resize(points);
    for (Eigen::Index i = 0; i < points; ++i)
      values[i] = p[0] * (1 - std::exp(-p[1] * x(i))) + bend_ * std::max(0., x(i) - p[1]);
    if (p[1] > jumps_at) values.array() += jump;
    return true;
  }
  bool slope(const VecX& p, MatX& J) override {
    J.resize(points, 2);
    for (Eigen::Index i = 0; i < points; ++i) {
      J(i, 0) = 1 - std::exp(-p[1] * x(i));
      J(i, 1) = p[0] * x(i) * std::exp(-p[1] * x(i));
      if (x(i) > p[1]) J(i, 1) -= bend_;
    }
    return true;
  }
  int calls = 0;
  double no_model_above = 1e9;
  double jump = 0, jumps_at = 1e9;  // of all values, where p[1] is larger

 private:
  static constexpr Eigen::Index points = 30;
  static double x(Eigen::Index i) { return 0.1 * static_cast<double>(i + 1); }
  double bend_;
  VecX measured_, weight_;
  std::vector<Eigen::Index> curves_{points};
};

struct Asked {
  std::shared_ptr<Curve> curve;
  FitProblem problem;
  FitResult fit;
  CostlyTests costly;
};

Asked asked(double bend, double lower_b = 0) {
  Asked one;
  one.curve = std::make_shared<Curve>(bend);
  one.problem.law.matrix = {Yeoh{1, 1, 0}};
  one.problem.free = {{"matrix.yeoh.a1", 1.5, 0, 10}, {"matrix.yeoh.a2", 1, lower_b, 10}};
  one.problem.further = one.curve;
  one.fit = fit(one.problem, {4, 1, {}});
  REQUIRE(std::isfinite(one.fit.best.cost));
  one.costly.tests = one.curve;
  one.costly.problem_with = [problem = one.problem](const std::shared_ptr<FurtherTests>& others) {
    FitProblem with = problem;
    with.further = others;
    return with;
  };
  one.curve->calls = 0;
  return one;
}

// The share of the density below a value of a column, by a sum over a grid somewhat wider than the
// samples.
double share_below(const Asked& one, const MatX& samples, Eigen::Index column, double value) {
  constexpr int cells = 500;
  VecX low = samples.colwise().minCoeff();
  const VecX wide = samples.colwise().maxCoeff().transpose() - low;
  low -= 0.2 * wide;
  const VecX step = 1.4 * wide / cells;
  double below = 0;
  double all = 0;
  VecX values;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j) {
      const VecX p{{low[0] + (i + 0.5) * step[0], low[1] + (j + 0.5) * step[1]}};
      if (p[1] < one.problem.free[1].lower || !one.curve->model(p, values)) continue;
      const double square =
          one.curve->weight().cwiseProduct(values - one.curve->measured()).squaredNorm();
      const double density = std::exp(-0.5 * (square - 2 * one.fit.best.cost));
      all += density;
      // the part of the cell that lies below
      below += density * std::clamp((value - p[column]) / step[column] + 0.5, 0., 1.);
    }
  return below / all;
}

// Quantiles have the shares that their names say, within four standard errors.
void check_quantiles(const Asked& one, const CostlyPosterior& found, Eigen::Index column) {
  RecordTable table = found.posterior.table;
  const auto at = static_cast<std::size_t>(column);
  for (const auto& [name, share] :
       {std::pair("lower_95", 0.025), {"quartile_1", 0.25}, {"median", 0.5}, {"upper_95", 0.975}}) {
    const double wanted = share;
    CAPTURE(column);
    CAPTURE(wanted);
    const double error = 4 * std::sqrt(share * (1 - share) / found.posterior.effective[at]);
    const double value = table.column(name).values[at];
    CHECK(share_below(one, found.posterior.samples, column, value) == near(share, 0, error));
  }
}

}  // namespace

TEST_CASE("polynomials of values and slopes repeat a polynomial, and its slopes, exactly") {
  struct Cubic : FurtherTests {
    VecX m = VecX::Zero(3), w = VecX::Ones(3);
    std::vector<Eigen::Index> c{3};
    const VecX& measured() const override { return m; }
    const VecX& weight() const override { return w; }
    const std::vector<Eigen::Index>& curves() const override { return c; }
    bool model(const VecX& p, VecX& v) override {
      v = VecX{{p[0] * p[0] * p[1], p[1] - 3, p[0] * p[0] * p[0] + p[1] * p[1]}};
      return true;
    }
    bool slope(const VecX& p, MatX& J) override {
      J = MatX{{2 * p[0] * p[1], p[0] * p[0]}, {0, 1}, {3 * p[0] * p[0], 2 * p[1]}};
      return true;
    }
  } cubic;
  std::vector<ModelPoint> points;
  Random random(1);
  for (int i = 0; i < 9; ++i) {
    ModelPoint one;
    one.p = VecX{{random.normal(), 100 + 10 * random.normal()}};
    cubic.model(one.p, one.values);
    cubic.slope(one.p, one.slope);
    points.push_back(one);
  }
  CHECK(coefficients(2, 3) == 10);
  CHECK(coefficients(5, 4) == 126);
  PolynomialTests fitted(cubic, points, 3);
  const VecX p{{0.7, 117}};
  VecX values, exact;
  MatX J, J_exact;
  REQUIRE(fitted.model(p, values));
  REQUIRE(fitted.slope(p, J));
  cubic.model(p, exact);
  cubic.slope(p, J_exact);
  CHECK((values - exact).norm() < 1e-9 * exact.norm());
  CHECK((J - J_exact).norm() < 1e-9 * J_exact.norm());
  SUBCASE("fewer combinations of many values have the same sum of squares") {
    PolynomialTests linear(cubic, points, 0);
    CHECK(linear.measured().size() == 2);
  }
}

TEST_CASE("a posterior of costly tests is that of its density, with a hundred runs") {
  const Asked one = asked(0);
  PosteriorConfig config;
  config.samples = 8000;
  const CostlyPosterior found = costly_posterior(one.costly, one.fit, config, 2);
  CHECK(found.proposals == 0);
  CHECK(found.reached);
  CHECK(found.runs <= 150);
  for (Eigen::Index j = 0; j < 2; ++j) check_quantiles(one, found, j);
  SUBCASE("and does not depend on threads") {
    config.samples = 200;
    const CostlyPosterior serial = costly_posterior(one.costly, one.fit, config, 1);
    const CostlyPosterior parallel = costly_posterior(one.costly, one.fit, config, 2);
    CHECK(serial.posterior.samples == parallel.posterior.samples);
  }
}

TEST_CASE("a bound in the middle of a posterior is a wall, not a place of more samples") {
  const Asked one = asked(0, 0.75);
  PosteriorConfig config;
  config.samples = 8000;
  const CostlyPosterior found = costly_posterior(one.costly, one.fit, config, 2);
  CHECK(found.reached);
  CHECK(found.posterior.divergences == 0);
  CHECK(found.posterior.samples.col(1).minCoeff() >= 0.75);
  check_quantiles(one, found, 1);
}

TEST_CASE("where a model has kinks, samples of polynomials are judged by runs") {
  const Asked one = asked(1.2);
  one.curve->jumps_at = one.fit.best.p[1];
  one.curve->jump = 0.02;
  PosteriorConfig config;
  config.samples = 6000;
  config.runs = 6000;
  config.shift = 0.01;
  const CostlyPosterior found = costly_posterior(one.costly, one.fit, config, 2);
  CHECK(found.proposals > 3000);
  CHECK(found.accepted > 0.5);
  CHECK(found.runs <= config.runs);
  for (Eigen::Index j = 0; j < 2; ++j) check_quantiles(one, found, j);
}

TEST_CASE("runs without an end are counted and said, and too many of them are an error") {
  Asked one = asked(0);
  PosteriorConfig config;
  config.samples = 400;
  one.curve->no_model_above = one.fit.best.p[1] + 0.1;
  const CostlyPosterior found = costly_posterior(one.costly, one.fit, config, 1);
  CHECK(found.without > 0);
  const auto warnings = costly_posterior_warnings(found, config);
  REQUIRE_FALSE(warnings.empty());
  CHECK(warnings.back().find("have no end") != std::string::npos);
  one.curve->no_model_above = 0;
  CHECK_THROWS_AS(costly_posterior(one.costly, one.fit, config, 1), Failure);
}

TEST_CASE("the budget of runs is kept, and what it does not reach is said") {
  const Asked one = asked(1.2);
  PosteriorConfig config;
  config.samples = 400;
  config.runs = 60;
  config.shift = 1e-3;
  const CostlyPosterior found = costly_posterior(one.costly, one.fit, config, 1);
  CHECK(found.runs <= 60);
  CHECK_FALSE(found.reached);
  CHECK(found.proposals == 0);
  const auto warnings = costly_posterior_warnings(found, config);
  REQUIRE_FALSE(warnings.empty());
  CHECK(warnings.back().find("study.posterior.runs") != std::string::npos);
}

}  // namespace costly_posterior_tests
