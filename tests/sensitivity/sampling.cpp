// Morris and Sobol on functions whose effects and shares are known in closed form.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identification/sensitivity/morris.hpp"
#include "identification/sensitivity/sobol.hpp"
#include "support/near.hpp"
#include "support/vec.hpp"

using namespace langer;
using test::vec;

namespace {

CurveMaker same(ParametricCurve phi) {
  return [phi] {
    return phi;
  };
}

// sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1 on [-pi, pi]^3
ParametricCurve ishigami() {
  return [](const VecX& x, VecX& y) {
    const double s = std::sin(x[1]);
    y = vec({std::sin(x[0]) + 7 * s * s + 0.1 * std::pow(x[2], 4) * std::sin(x[0])});
    return true;
  };
}

// product of (|4 x_i - 2| + a_i)/(1 + a_i) on [0, 1]^k
ParametricCurve sobol_g(const VecX& a) {
  return [a](const VecX& x, VecX& y) {
    double g = 1;
    for (Eigen::Index i = 0; i < x.size(); ++i) g *= (std::abs(4 * x[i] - 2) + a[i]) / (1 + a[i]);
    y = vec({g});
    return true;
  };
}

void check_within(const Estimate& e, const VecX& exact, double widest) {
  for (Eigen::Index i = 0; i < exact.size(); ++i) {
    CAPTURE(i);
    CHECK(e.low(i, 0) <= exact[i]);
    CHECK(e.high(i, 0) >= exact[i]);
    CHECK(e.low(i, 0) <= e.value(i, 0));
    CHECK(e.value(i, 0) <= e.high(i, 0));
    CHECK(e.high(i, 0) - e.low(i, 0) <= widest);
  }
}

bool equal(const MatX& A, const MatX& B) {
  return A.size() == B.size() && (A.array() == B.array()).all();
}

}  // namespace

TEST_CASE("Morris: a linear model has its slopes times the ranges and sigma = 0") {
  const auto phi = [](const VecX& p, VecX& y) {
    y = vec({3 * p[0] - 2 * p[1], 0.5 * p[1] + 7});
    return true;
  };
  const Morris e = morris(same(phi), vec({-4, 0}), vec({5, 10}), 20, 4, {});
  CHECK(e.trajectories == 20);
  const double slopes[2][2] = {{27, 0}, {-20, 5}};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      CHECK(e.mu.value(i, j) == near(slopes[i][j], 1e-12));
      CHECK(e.mu_star.value(i, j) == near(std::abs(slopes[i][j]), 1e-12));
      CHECK(e.sigma.value(i, j) <= 1e-12 * 27);
      CHECK(e.sigma.high(i, j) <= 1e-12 * 27);
    }
}

TEST_CASE(
    "Morris: mean, mean size and deviation are those of a sample of the effects along the paths") {
  // y = x1^2 + 3 x1 x2 + sin x3 on a box; what the paths visit is written down
  std::vector<VecX> points;
  std::vector<double> values;
  const auto phi = [&](const VecX& p, VecX& y) {
    y = vec({p[0] * p[0] + 3 * p[0] * p[1] + std::sin(p[2])});
    points.push_back(p), values.push_back(y[0]);
    return true;
  };
  const VecX lower = vec({-1, 0, 2}), upper = vec({1, 4, 5});
  for (int n : {2, 3, 7}) {
    CAPTURE(n);
    points.clear(), values.clear();
    SamplingOptions options;
    options.resamples = 10;
    const Morris e = morris(same(phi), lower, upper, n, 6, options);
    REQUIRE(e.trajectories == n);
    REQUIRE(points.size() == static_cast<std::size_t>(4 * n));
    std::vector<std::vector<double>> effects(3);
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (i % 4 == 0) continue;  // the next path begins
      const VecX moved = (points[i] - points[i - 1]).cwiseQuotient(upper - lower);
      Eigen::Index k;
      moved.cwiseAbs().maxCoeff(&k);
      CHECK(moved.cwiseAbs().sum() ==
            near(0.6));  // levels/(2 (levels - 1)), by one parameter alone
      effects[static_cast<std::size_t>(k)].push_back((values[i] - values[i - 1]) / moved[k]);
    }
    for (int k = 0; k < 3; ++k) {
      const auto& all = effects[static_cast<std::size_t>(k)];
      REQUIRE(all.size() == static_cast<std::size_t>(n));  // each parameter moves once on each path
      double mu = 0, mu_star = 0, pairs = 0;
      for (double a : all) {
        mu += a / n, mu_star += std::abs(a) / n;
        for (double b : all) pairs += (a - b) * (a - b);
      }
      CHECK(e.mu.value(k, 0) == near(mu, 1e-10));
      CHECK(e.mu_star.value(k, 0) == near(mu_star, 1e-10));
      // 0 for a parameter of linear effect. The unbiased variance: half the mean square of the
      // differences of two effects
      CHECK(e.sigma.value(k, 0) ==
            near(std::sqrt(pairs / (2.0 * n * (n - 1))), 1e-10, 1e-10 * mu_star));
    }
  }
}

TEST_CASE("Morris: an interaction shows as sigma, which one-at-a-time effects do not see") {
  //   y = x1 x2 on [-1, 1]^2: at the middle neither moves anything
  const auto phi = [](const VecX& p, VecX& y) {
    y = vec({p[0] * p[1]});
    return true;
  };
  const OneAtATime paper = one_at_a_time(phi, vec({0, 0}), vec({-1, -1}), vec({1, 1}), 1000);
  CHECK(paper.mu_star.maxCoeff() == 0);
  CHECK(paper.spread.maxCoeff() == 0);
  SamplingOptions options;
  options.groups = {{0}};
  const Morris e = morris(same(phi), vec({-1, -1}), vec({1, 1}), 2000, 4, options);
  // effects are 2 x_other with x_other in {-1, -1/3, 1/3, 1}: mean 0, mean size 4/3, variance 20/9
  for (int i = 0; i < 2; ++i) {
    CHECK(e.mu.low(i, 0) <= 0);
    CHECK(e.mu.high(i, 0) >= 0);
    CHECK(e.mu_star.low(i, 0) <= 4. / 3);
    CHECK(e.mu_star.high(i, 0) >= 4. / 3);
    CHECK(e.sigma.low(i, 0) <= std::sqrt(20. / 9));
    CHECK(e.sigma.high(i, 0) >= std::sqrt(20. / 9));
    CHECK(e.mu_star.high(i, 0) - e.mu_star.low(i, 0) <= 0.1);
    CHECK(e.group_mu_star.value(i, 0) == e.mu_star.value(i, 0));
    CHECK(e.group_sigma.high(i, 0) == e.sigma.high(i, 0));
  }
}

TEST_CASE("Sobol: Ishigami's shares lie within their intervals") {
  const double pi = std::numbers::pi, a = 7, b = 0.1;
  const double V1 = std::pow(1 + b * std::pow(pi, 4) / 5, 2) / 2, V2 = a * a / 8,
               V13 = b * b * std::pow(pi, 8) * 8 / 225;
  const double V = V1 + V2 + V13;
  const Sobol s = sobol(same(ishigami()), vec({-pi, -pi, -pi}), vec({pi, pi, pi}), 65536, {});
  CHECK(s.curves == 65536 * 5);
  check_within(s.first, vec({V1 / V, V2 / V, 0}), 0.03);
  check_within(s.total, vec({(V1 + V13) / V, V2 / V, V13 / V}), 0.03);
  CHECK(s.mean[0] == near(a / 2, 0.01));
  CHECK(s.deviation[0] == near(std::sqrt(V), 0.01));
}

TEST_CASE("Sobol: the G function's shares lie within their intervals") {
  const VecX a = vec({0, 1, 4.5, 9, 99});
  double V = 1;
  VecX V_i(5), first(5), total(5);
  for (int i = 0; i < 5; ++i) V_i[i] = 1 / (3 * (1 + a[i]) * (1 + a[i])), V *= 1 + V_i[i];
  for (int i = 0; i < 5; ++i)
    first[i] = V_i[i] / (V - 1), total[i] = V_i[i] * (V / (1 + V_i[i])) / (V - 1);
  SamplingOptions options;
  options.sequence = Sequence::random;
  const Sobol s = sobol(same(sobol_g(a)), VecX::Zero(5), VecX::Ones(5), 65536, options);
  check_within(s.first, first, 0.03);
  check_within(s.total, total, 0.03);
  // by the sequence the shares themselves, to a few digits more
  options.sequence = Sequence::sobol;
  const Sobol t = sobol(same(sobol_g(a)), VecX::Zero(5), VecX::Ones(5), 65536, options);
  CHECK((t.first.value.col(0) - first).cwiseAbs().maxCoeff() <= 1e-3);
  CHECK((t.total.value.col(0) - total).cwiseAbs().maxCoeff() <= 1e-3);
}

TEST_CASE("Sobol's intervals hold the truth about as often as they say") {
  const double pi = std::numbers::pi, V1 = std::pow(1 + 0.1 * std::pow(pi, 4) / 5, 2) / 2;
  const double V = V1 + 49. / 8 + 0.01 * std::pow(pi, 8) * 8 / 225;
  int held = 0, held_by_sequence = 0;
  constexpr int studies = 200;
  for (int study = 0; study < studies; ++study) {
    SamplingOptions options;
    options.seed = 1000 + static_cast<std::uint64_t>(study), options.resamples = 200;
    const auto holds = [&](Sequence sequence) {
      options.sequence = sequence;
      const Sobol s =
          sobol(same(ishigami()), vec({-pi, -pi, -pi}), vec({pi, pi, pi}), 1024, options);
      return s.first.low(0, 0) <= V1 / V && V1 / V <= s.first.high(0, 0);
    };
    held += holds(Sequence::random), held_by_sequence += holds(Sequence::sobol);
  }
  CHECK(held >= 0.90 * studies);
  CHECK(held <= 0.99 * studies);
  CHECK(held_by_sequence >= 0.95 * studies);  // its rows are counted as independent
}

TEST_CASE(
    "Results do not depend on the number of threads, and points without a curve are counted") {
  const auto phi = [](const VecX& p, VecX& y) {
    y = vec({std::exp(p[0]) * p[1], p[1] * p[1] + p[0], 3});
    return p[0] < 0.99;
  };
  SamplingOptions one;
  one.groups = {{0, 1}, {2}};
  SamplingOptions four = one;
  four.threads = 4;
  const VecX lower = vec({0, -1}), upper = vec({1, 1});
  const Sobol s = sobol(same(phi), lower, upper, 3000, one),
              t = sobol(same(phi), lower, upper, 3000, four);
  CHECK(s.without_curve > 10);
  CHECK(s.rows + s.without_curve == 3000);
  CHECK(s.without_curve == t.without_curve);
  CHECK(equal(s.group_first.value, t.group_first.value) ==
        false);  // NaN: the third point has no variance
  CHECK(std::isnan(s.first.value(0, 2)));
  CHECK(equal(s.first.value.leftCols(2), t.first.value.leftCols(2)));
  CHECK(equal(s.total.low.leftCols(2), t.total.low.leftCols(2)));
  CHECK(equal(s.group_total.high.leftCols(1), t.group_total.high.leftCols(1)));
  const Morris m = morris(same(phi), lower, upper, 50, 4, one),
               n = morris(same(phi), lower, upper, 50, 4, four);
  CHECK(m.without_curve > 5);
  CHECK(m.trajectories + m.without_curve == 50);
  CHECK(equal(m.mu_star.low, n.mu_star.low));
  CHECK(equal(m.sigma.value, n.sigma.value));
}

TEST_CASE(
    "Sobol and Morris tell how far they are, growing to the whole, on any number of threads") {
  const auto phi = [](const VecX& p, VecX& y) {
    y = p;
    return true;
  };
  std::vector<double> told;
  SamplingOptions options;
  options.threads = 3, options.progress = [&](double part) {
    told.push_back(part);
  };
  sobol(same(phi), vec({0, 0}), vec({1, 1}), 640, options);
  CHECK(told.size() > 9);  // in tenths at least
  CHECK(std::is_sorted(told.begin(), told.end()));
  CHECK(told.back() == 1);
  told.clear();
  morris(same(phi), vec({0, 0}), vec({1, 1}), 20, 4, options);
  CHECK(told.size() == 20);
  CHECK(std::is_sorted(told.begin(), told.end()));
  CHECK(told.back() == 1);
}
