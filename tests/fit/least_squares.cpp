// Bounded least squares: optimality at active bounds, hard valleys, models with holes, covariance.
#include "identification/fit/least_squares.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/tensor/dense.hpp"
#include "identification/fit/bounded_linear.hpp"
#include "support/near.hpp"
#include "support/vec.hpp"

using namespace langer;
using test::vec;

namespace least_squares_tests {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

// y = p0 exp(p1 x)
struct Exponential {
  VecX x, y;
  LeastSquares problem(const VecX& start, const VecX& lower, const VecX& upper) const {
    LeastSquares q;
    q.residual = [this](const VecX& p, VecX& r) {
      r = p[0] * (p[1] * x.array()).exp().matrix() - y;
      return true;
    };
    q.start = start, q.lower = lower, q.upper = upper, q.typical = VecX::Ones(2), q.size = y.norm();
    return q;
  }
  double cost(double p0, double p1) const {
    return 0.5 * (p0 * (p1 * x.array()).exp().matrix() - y).squaredNorm();
  }
  double best_p0(double p1) const {  // closed form, p0 being linear
    const VecX e = (p1 * x.array()).exp();
    return e.dot(y) / e.squaredNorm();
  }
};

Exponential growth() {
  Exponential e;
  e.x = VecX::LinSpaced(26, 0, 5);
  e.y = (0.3 * e.x.array() + 0.1).exp() + 0.2 * (7 * e.x.array()).sin();
  return e;
}

}  // namespace

TEST_CASE("the bounded linear problem is solved exactly: no better set of held variables exists") {
  std::mt19937 rng(31);
  std::normal_distribution<double> x;
  const int n = 4, m = 6;
  for (int trial = 0; trial < 200; ++trial) {
    const MatX A = MatX::NullaryExpr(m, n, [&](Eigen::Index, Eigen::Index) { return x(rng); });
    const VecX b = VecX::NullaryExpr(m, [&](Eigen::Index) { return 3 * x(rng); });
    const VecX lower = VecX::NullaryExpr(n, [&](Eigen::Index) { return -std::abs(x(rng)); });
    const VecX upper =
        VecX::NullaryExpr(n, [&](Eigen::Index) { return trial % 3 ? std::abs(x(rng)) : inf; });
    const VecX found = bounded_linear(A, b, lower, upper);
    CHECK((found.array() >= lower.array()).all());
    CHECK((found.array() <= upper.array()).all());
    double best = inf;
    for (int set = 0; set < 81; ++set) {  // each variable free, low or high
      VecX held = VecX::Zero(n);
      std::vector<int> free;
      for (int i = 0, s = set; i < n; ++i, s /= 3) {
        if (s % 3 == 0) free.push_back(i);
        if (s % 3 == 1) held[i] = lower[i];
        if (s % 3 == 2) held[i] = upper[i];
      }
      if (!held.array().isFinite().all()) continue;
      if (!free.empty()) held(free) = PivotedQr(A(Eigen::all, free)).solve(b - A * held);
      if ((held.array() < lower.array()).any() || (held.array() > upper.array()).any()) continue;
      best = std::min(best, (A * held - b).norm());
    }
    CHECK((A * found - b).norm() <= best * (1 + 1e-12));
  }
}

TEST_CASE("an exponential with its rate on the bound converges to the true constrained optimum") {
  const Exponential e = growth();
  const double bound = 0.25;  // the free optimum lies near 0.3
  const double p0 = e.best_p0(bound);
  for (const VecX& start :
       {vec({1, 0}), vec({5, -2}), vec({0.01, 0.25}), vec({-3, 0.2}), vec({20, 0.25})}) {
    const auto s = least_squares(e.problem(start, vec({-inf, -inf}), vec({inf, bound})));
    CHECK(s.converged);
    CHECK(s.kkt <= 1e-8);
    CHECK(s.p[1] == bound);
    CHECK(s.at_bound == std::vector{false, true});
    CHECK(std::abs(s.p[0] - p0) <= 1e-9 * p0);
    CHECK(s.cost <= e.cost(p0, bound) * (1 + 1e-14));
  }
}

TEST_CASE("an exponential with its factor on the bound converges to the true constrained optimum") {
  const Exponential e = growth();
  const double bound = 0.8;
  // the cost in p1 alone has one minimum here: golden sections
  double low = 0, high = 1;
  for (int i = 0; i < 200; ++i) {
    const double a = high - 0.618034 * (high - low), b = low + 0.618034 * (high - low);
    (e.cost(bound, a) < e.cost(bound, b) ? high : low) =
        e.cost(bound, a) < e.cost(bound, b) ? b : a;
  }
  for (const VecX& start : {vec({0.1, 0}), vec({0.8, 1}), vec({0.8, -1}), vec({-1, 0.3})}) {
    const auto s = least_squares(e.problem(start, vec({-inf, -inf}), vec({bound, inf})));
    CHECK(s.kkt <= 1e-8);
    CHECK(s.p[0] == bound);
    CHECK(std::abs(s.p[1] - low) <= 1e-7);  // of golden sections: the square root of eps
    CHECK(s.cost <= e.cost(bound, low) * (1 + 1e-14));
  }
}

TEST_CASE("without active bounds the answer is stationary and inside") {
  const Exponential e = growth();
  const auto s = least_squares(e.problem(vec({1, 0}), vec({-10, -10}), vec({10, 10})));
  CHECK(s.converged);
  CHECK(std::abs(s.p[0] - e.best_p0(s.p[1])) <= 1e-10);
  CHECK(s.at_bound == std::vector{false, false});
  // analytic gradient
  const VecX f = (s.p[1] * e.x.array()).exp();
  CHECK(std::abs(f.dot(s.r)) <= 1e-10 * f.norm() * e.y.norm());
  CHECK(std::abs(f.cwiseProduct(e.x).dot(s.r)) <= 1e-10 * f.cwiseProduct(e.x).norm() * e.y.norm());
}

TEST_CASE("Rosenbrock's valley is followed to its end, also along a bound") {
  LeastSquares q;
  q.residual = [](const VecX& p, VecX& r) {
    r = vec({10 * (p[1] - p[0] * p[0]), 1 - p[0]});
    return true;
  };
  q.start = vec({-1.2, 1}), q.lower = vec({-inf, -inf}), q.upper = vec({inf, inf}),
  q.typical = vec({1, 1});
  CHECK((least_squares(q).p - vec({1, 1})).norm() <= 1e-10);
  // p0 <= 0.5: p1 = p0^2 keeps the first residual at zero
  q.upper = vec({0.5, inf});
  const auto s = least_squares(q);
  CHECK(s.kkt <= 1e-8);
  CHECK((s.p - vec({0.5, 0.25})).norm() <= 1e-10);
  CHECK(s.cost == near(0.125, 1e-12));
}

TEST_CASE("a fixed parameter stays, and a parameter without effect does no harm") {
  const Exponential e = growth();
  auto q = e.problem(vec({1, 0.2}), vec({-10, 0.2}), vec({10, 0.2}));
  auto s = least_squares(q);
  CHECK(s.p[1] == 0.2);
  CHECK(s.p[0] == near(e.best_p0(0.2), 1e-10));

  q = e.problem(vec({1, 0, 7}), vec({-10, -10, -10}), vec({10, 10, 10}));
  q.typical = VecX::Ones(3);
  s = least_squares(q);
  CHECK(s.converged);
  CHECK(s.p[2] == 7);
  const MatX cov = covariance(s);
  CHECK(std::isfinite(cov(0, 1)));
  CHECK(std::isnan(cov(2, 2)));
}

TEST_CASE(
    "at a kink of the model a search ends where what is left is far below the standard errors, and only there") {
  // f = p x + k x^2 |p - c|, and data whose optimum is the kink: from either side J^T r points to
  // it and does not vanish
  const double c = 2;
  const VecX x = VecX::LinSpaced(20, 0.05, 1), xx = x.cwiseAbs2();
  const VecX missed = -2 * (xx - xx.dot(x) / x.squaredNorm() * x);
  const auto search = [&](double k) {
    LeastSquares q;
    q.residual = [&, k](const VecX& p, VecX& r) {
      r = (p[0] - c) * x + k * std::abs(p[0] - c) * xx - missed;
      return true;
    };
    q.slope = [&, k](const VecX& p, MatX& J) {
      J = x + (p[0] < c ? -k : k) * xx;
      return true;
    };
    q.start = vec({0.5}), q.lower = vec({-inf}), q.upper = vec({inf}), q.typical = vec({1}),
    q.size = (c * x + missed).norm();
    return least_squares(q, {.iterations = 60, .kkt = 1e-11, .step = 1e-8, .good_enough = 1e-5});
  };
  const LeastSquaresResult slight = search(0.02), strong = search(0.2);
  CHECK(slight.converged);
  CHECK(slight.kkt > 1e-4);
  CHECK(slight.why == "optimal to a thirtieth of the standard errors; the model has kinks");
  CHECK(std::abs(slight.p[0] - c) < 0.03 * std::sqrt(covariance(slight)(0, 0)));
  CHECK_FALSE(strong.converged);
  CHECK(strong.p[0] == near(c));
}

TEST_CASE("steps into a region without model are shortened, a start without model is reported") {
  LeastSquares q;  // r = sqrt(p) - 2, defined for p >= 0 only
  q.residual = [](const VecX& p, VecX& r) {
    r = vec({std::sqrt(std::abs(p[0])) - 2});
    return p[0] >= 0;
  };
  q.start = vec({1e-3}), q.lower = vec({-100}), q.upper = vec({100}), q.typical = vec({1e-4}),
  q.size = 2;
  const auto s = least_squares(q);
  CHECK(s.converged);
  CHECK(s.p[0] == near(4, 1e-10));
  q.start = vec({-1});
  const auto none = least_squares(q);
  CHECK(!none.converged);
  CHECK(none.cost == inf);
  CHECK(none.why == "the model does not exist at the start");
}

TEST_CASE(
    "differences of fourth order give the Jacobian, also against a bound and from inside a narrow box") {
  const Exponential e = growth();
  const double p0 = 1.3, p1 = 0.4;
  for (const auto& [lower, upper] :
       {std::pair{-inf, inf}, std::pair{p1, inf}, std::pair{-inf, p1}, std::pair{p1 - 1e-4, 5.},
        std::pair{-5., p1 + 1e-4}, std::pair{p1 - 1e-3, p1 + 2e-3}}) {
    const auto q = e.problem(vec({p0, p1}), vec({-inf, lower}), vec({inf, upper}));
    MatX J;
    REQUIRE(jacobian(q, q.start, J));
    const VecX f = (p1 * e.x.array()).exp();
    CHECK((J.col(0) - f).norm() <= 1e-11 * f.norm());
    const VecX df = p0 * f.cwiseProduct(e.x);
    // one-sided: h^4/5 times the fifth derivative, up to 3e3 here; in the narrow box eps/h
    CHECK((J.col(1) - df).norm() <= 1e-9 * df.norm());
  }
}

TEST_CASE(
    "the covariance of a straight line is the textbook's, and covers the truth as often as it says") {
  const VecX x = VecX::LinSpaced(21, -1, 1);
  std::mt19937 rng(32);
  std::normal_distribution<double> noise(0, 0.1);
  int covered = 0;
  const int trials = 2000;
  for (int trial = 0; trial < trials; ++trial) {
    const VecX y =
        2 * x.array() + 1 + VecX::NullaryExpr(21, [&](Eigen::Index) { return noise(rng); }).array();
    LeastSquares q;
    q.residual = [&](const VecX& p, VecX& r) {
      r = p[0] * VecX::Ones(21) + p[1] * x - y;
      return true;
    };
    q.start = vec({0, 0}), q.lower = vec({-inf, -inf}), q.upper = vec({inf, inf}),
    q.typical = vec({1, 1}), q.size = y.norm();
    const auto s = least_squares(q);
    const MatX cov = covariance(s);
    if (trial == 0) {
      const double variance = s.r.squaredNorm() / 19;
      CHECK(cov(0, 0) == near(variance / 21, 1e-9));
      CHECK(cov(1, 1) == near(variance / x.squaredNorm(), 1e-9));
      CHECK(std::abs(cov(0, 1)) <= 1e-9 * cov(0, 0));
    }
    covered += std::abs(s.p[1] - 2) <=
               2.093 * std::sqrt(cov(1, 1));  // Student's t, 19 degrees of freedom, 95 %
  }
  // binomial: 3 standard deviations are 1.5 percent
  CHECK(std::abs(covered / double(trials) - 0.95) <= 0.015);
}

TEST_CASE(
    "A start where a parameter has no first effect is no optimum unless both sides are higher") {
  LeastSquares
      q;  // r = (p^2 - 1, 0.1 p^2): at p = 0 flat and a maximum of the cost, least at p^2 = 1/1.01
  q.residual = [](const VecX& p, VecX& r) {
    r = vec({p[0] * p[0] - 1, 0.1 * p[0] * p[0]});
    return true;
  };
  q.start = vec({0}), q.lower = vec({-5}), q.upper = vec({5}), q.typical = vec({1}), q.size = 1;
  const auto s = least_squares(q);
  CHECK(s.converged);
  CHECK(s.kkt <= 1e-8);
  CHECK(std::abs(s.p[0]) == near(std::sqrt(1 / 1.01), 1e-9));
  // at a bound there is one side only
  q.lower = vec({0});
  CHECK(least_squares(q).p[0] == near(std::sqrt(1 / 1.01), 1e-9));

  // here the flat place is the optimum: reached from far, where J^T J alone tells nothing of the
  // curvature
  q.residual = [](const VecX& p, VecX& r) {
    r = vec({2 - std::cos(p[0]) + p[1], 1 + 0.3 * p[1]});
    return true;
  };
  q.lower = vec({-1, -0.5}), q.upper = vec({2, 5}), q.typical = vec({1, 1}), q.size = 2;
  for (const VecX& start : {vec({0, 0}), vec({1.2, 2}), vec({-0.9, -0.2})}) {
    q.start = start;
    const auto flat = least_squares(q);
    CHECK(flat.converged);
    CHECK(flat.kkt <= 1e-8);
    CHECK(std::abs(flat.p[0]) <= 1e-6);
    CHECK(flat.p[1] == -0.5);
  }
}

}  // namespace least_squares_tests
