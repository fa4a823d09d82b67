// Newton, load path and linear solver on problems that know no mechanics.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "core/base/in_order.hpp"
#include "mechanics/linear/linear.hpp"
#include "mechanics/nonlinear/load_path.hpp"
#include "mechanics/nonlinear/newton.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// gradient of Rosenbrock's function as a Problem
struct Rosenbrock {
  VecX at;
  std::vector<double> residuals;
  static VecX f(const VecX& x) {
    VecX g(2);
    g << -2 * (1 - x[0]) - 400 * x[0] * (x[1] - x[0] * x[0]), 200 * (x[1] - x[0] * x[0]);
    return g;
  }
  Problem problem() {
    Problem p;
    p.assess = [this](const VecX& x, bool) {
      at = x;
      Assessment a;
      a.residual = f(x).norm(), a.reference = 1;
      residuals.push_back(a.residual);
      return a;
    };
    p.correction = [this]() -> std::optional<VecX> {
      Eigen::Matrix2d H;
      H << 2 - 400 * at[1] + 1200 * at[0] * at[0], -400 * at[0], -400 * at[0], 200;
      return VecX(-H.inverse() * f(at));
    };
    p.admissible = [](const VecX&) {
      return true;
    };
    p.moved = [](const VecX&, double) {
    };
    return p;
  }
};

Pattern chain(int n) {
  Pattern p;
  p.n = n;
  p.column_start = {0};
  for (int c = 0; c < n; ++c) {
    p.row.push_back(c);
    if (c + 1 < n) p.row.push_back(c + 1);
    if (c + 7 < n) p.row.push_back(c + 7);
    p.column_start.push_back(p.nnz());
  }
  return p;
}

MatX dense(const Pattern& p, const std::vector<double>& values) {
  MatX A = MatX::Zero(p.n, p.n);
  for (int c = 0; c < p.n; ++c)
    for (int k = p.column_start[c]; k < p.column_start[c + 1]; ++k)
      A(p.row[k], c) = A(c, p.row[k]) = values[k];
  return A;
}

}  // namespace

TEST_CASE("Newton finds Rosenbrock's minimum with a quadratic tail") {
  Rosenbrock r;
  VecX x(2);
  x << 0.8, 0.6;
  const SolveReport report = newton(r.problem(), x, {});
  CHECK(report.converged());
  CHECK((x - VecX::Ones(2)).norm() < 1e-9);
  const auto& f = r.residuals;
  REQUIRE(f.size() >= 3);
  CHECK(f.back() < 1e-9);
  CHECK(report.iterations <= 8);
}

TEST_CASE(
    "no component moves further in an iteration than the largest move; the step keeps its direction") {
  Rosenbrock r;
  for (double largest : {0.03, 0.3, 100.0}) {
    CAPTURE(largest);
    VecX x(2);
    x << -1.2, 1;
    VecX before = x;
    int shortened = 0;
    Problem p = r.problem();
    p.moved = [&](const VecX& dx, double step) {
      const double longest = dx.lpNorm<Eigen::Infinity>();
      CHECK(step == near(std::min(1.0, largest / longest), 1e-14));
      CHECK(step * longest <= largest * (1 + 1e-14));
      shortened += step < 1;
    };
    NewtonOptions options;
    options.iterations = 200, options.largest_move = largest;
    const SolveReport report = newton(p, x, options);
    CHECK(report.converged());
    CHECK((x - VecX::Ones(2)).norm() < 1e-6);
    CHECK((shortened > 0) == (largest < 1));
  }
}

TEST_CASE(
    "Newton says why it stops: too few iterations, a singular tangent, a force that is not finite") {
  Rosenbrock r;
  VecX x(2);
  x << -1.2, 1;
  NewtonOptions one;
  one.iterations = 1;
  const SolveReport few = newton(r.problem(), x, one);
  CHECK(few.outcome == Outcome::not_converged);
  CHECK(few.why.find("after 1 iterations") != std::string::npos);
  Problem p = r.problem();
  p.correction = []() -> std::optional<VecX> {
    return std::nullopt;
  };
  CHECK(newton(p, x, {}).outcome == Outcome::singular);
  p = r.problem();
  p.assess = [](const VecX&, bool) {
    return Assessment{true, std::nan(""), 1, 0, true, ""};
  };
  CHECK(newton(p, x, {}).outcome == Outcome::inadmissible);
  p = r.problem();
  p.correction = []() -> std::optional<VecX> {
    return VecX::Constant(2, std::nan(""));
  };
  CHECK(newton(p, x, {}).outcome == Outcome::singular);
}

TEST_CASE("the load path cuts back, grows again, hits its stops and ends at 1") {
  LoadPathOptions options;
  options.first = options.largest = 0.25, options.smallest = 1e-4;
  std::vector<double> reached;
  // steps over the hard place 0.4 ... 0.5 fail when longer than 0.03
  double from = 0;
  const auto attempt = [&](double t) {
    SolveReport r;
    r.outcome =
        t - from > 0.03 && t > 0.4 && from < 0.5 ? Outcome::not_converged : Outcome::converged;
    r.iterations = 3;
    return r;
  };
  const PathReport report =
      load_path(options, 0, {}, {0.3}, attempt, [&](double t, double, double, const SolveReport&) {
        reached.push_back(from = t);
        return true;
      });
  CHECK(report.complete);
  CHECK(reached.back() == 1);
  CHECK(std::find(reached.begin(), reached.end(), 0.3) != reached.end());
  CHECK(report.cut_backs >= 2);
  double widest = 0;
  for (std::size_t i = 1; i < reached.size(); ++i)
    widest = std::max(widest, reached[i] - reached[i - 1]);
  CHECK(widest > 0.1);  // grown again after the hard place
}

TEST_CASE(
    "increments grow by half where the step was easy, stay where it was not, and are no longer than the largest") {
  LoadPathOptions options;
  options.first = 0.001, options.largest = 0.2, options.easy = 4;
  std::vector<double> taken, asked;
  int iterations = options.easy;
  const auto attempt = [&](double) {
    SolveReport r;
    r.outcome = Outcome::converged, r.iterations = iterations;
    return r;
  };
  const auto accepted = [&](double t, double by, double next, const SolveReport&) {
    taken.push_back(by), asked.push_back(next);
    iterations = t > 0.1 && t < 0.3 ? options.easy + 1 : options.easy;
    return true;
  };
  REQUIRE(load_path(options, 0, {}, {}, attempt, accepted).complete);
  double t = taken[0];
  int grown = 0, kept = 0;
  for (std::size_t i = 1; t < 0.8; t += taken[i++]) {  // the last ones are made to end at 1
    CHECK(taken[i] == near(asked[i - 1], 1e-10));
    const bool hard = t > 0.1 && t < 0.3;
    const double expected = hard ? taken[i] : std::min(options.largest, 1.5 * taken[i]);
    CHECK(asked[i] == near(expected, 1e-10));
    ++(hard ? kept : grown);
  }
  CHECK(grown > 10);
  CHECK(kept >= 2);
  CHECK(*std::max_element(taken.begin(), taken.end()) <= options.largest * (1 + 1e-10));
}

TEST_CASE("the load path gives up at the smallest increment and keeps what was reached") {
  LoadPathOptions options;
  options.smallest = 1e-3;
  const PathReport report = load_path(
      options, 0, {}, {},
      [&](double t) {
        SolveReport r;
        r.outcome = t > 0.55 ? Outcome::not_converged : Outcome::converged;
        r.why = "a wall";
        return r;
      },
      [](double, double, double, const SolveReport&) { return true; });
  CHECK_FALSE(report.complete);
  CHECK(report.why == "a wall");
  CHECK(report.t > 0.54);
  CHECK(report.t <= 0.55);
}

TEST_CASE("a fixed number of steps lands on equal fractions") {
  LoadPathOptions options;
  options.steps = 100;
  std::vector<double> reached;
  load_path(
      options, 0, {}, {},
      [&](double) {
        SolveReport r;
        r.outcome = Outcome::converged;
        return r;
      },
      [&](double t, double, double, const SolveReport&) {
        reached.push_back(t);
        return true;
      });
  REQUIRE(reached.size() == 100);
  for (int i = 0; i < 100; ++i) CHECK(reached[i] == (i + 1) / 100.0);
}

TEST_CASE("solvers that are made side by side order their unknowns as one alone does") {
  const int n = 40;  // an n x n grid
  Pattern p;
  p.n = n * n, p.column_start = {0};
  for (int c = 0; c < p.n; ++c) {
    p.row.push_back(c);
    if (c % n + 1 < n) p.row.push_back(c + 1);
    if (c + n < p.n) p.row.push_back(c + n);
    p.column_start.push_back(static_cast<int>(p.row.size()));
  }
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0.5, 1);
  std::vector<double> values(p.nnz());
  for (double& v : values) v = -u(random);
  for (int c = 0; c < p.n; ++c) values[p.column_start[c]] = 5;
  VecX b(p.n);
  for (double& v : b) v = u(random);
  const auto solution = [&] {
    LinearSolver linear(p, {});
    return linear.factorize(values) ? linear.solve(b) : VecX();
  };
  const VecX alone = solution();
  REQUIRE(alone.size() == p.n);
  std::vector<VecX> beside(40);
  in_order(
      4, 40, [&](int, int i) { beside[i] = solution(); }, [](int, int) {});
  for (const VecX& x : beside) CHECK(x == alone);  // to the last bit: the same ordering
}

TEST_CASE("a matrix that is factorized in a given order has the same solution and signs") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-1, 1);
  const Pattern p = chain(60);
  std::vector<double> values(p.nnz());
  for (double& v : values) v = u(random);
  for (int c = 0; c < p.n; ++c) values[p.column_start[c]] = 5;
  VecX b(p.n);
  for (double& v : b) v = u(random);
  LinearSolver first(p);
  std::vector<int> backwards(first.order().rbegin(), first.order().rend());
  LinearSolver given(p, LinearSolver::Order(backwards), 1);
  CHECK(given.order() == backwards);
  REQUIRE(first.factorize(values));
  REQUIRE(given.factorize(values));
  const VecX x = first.solve(b);
  CHECK((given.solve(b) - x).norm() < 1e-13 * x.norm());
  CHECK((dense(p, values) * x - b).norm() < 1e-13 * b.norm());
  for (const int c : {5, 30, 31}) values[p.column_start[c]] = -5;
  CHECK_FALSE(given.factorize(values));
  CHECK(given.negative_pivots(values) == 3);
  CHECK(first.negative_pivots(values) == 3);
}

TEST_CASE("the linear solver handles definite, indefinite and singular matrices and says which") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-1, 1);
  const Pattern p = chain(60);
  std::vector<double> values(p.nnz());
  for (double& v : values) v = u(random);
  for (int c = 0; c < p.n; ++c) values[p.column_start[c]] = 5;
  const std::vector<int> last{3, 50, 17, 4, 40};
  LinearSolver linear(p, last);
  VecX b(p.n);
  for (double& v : b) v = u(random);
  MatX B(5, 3);
  for (auto& v : B.reshaped()) v = u(random);
  for (double shift : {0.0, -5.5}) {
    for (int c = 0; c < p.n; ++c) values[p.column_start[c]] = 5 + (c % 3 == 0 ? shift * 2 : 0);
    const MatX A = dense(p, values);
    CHECK(linear.factorize(values) == (shift == 0));
    if (shift != 0) CHECK(linear.factorize_indefinite(values));
    CHECK((A * linear.solve(b) - b).norm() < 1e-11 * b.norm());
    MatX full = MatX::Zero(p.n, 3);
    for (int i = 0; i < 5; ++i) full.row(last[i]) = B.row(i);
    const MatX W = full.transpose() * A.inverse() * full;
    CHECK((linear.compliance(B) - W).norm() < 1e-11 * W.norm());

    // in two halves, with what is added between them
    const LinearSolver::Half half = linear.start(b);
    const VecX x = linear.solve(b);
    VecX c(5), whole = b;
    for (int i = 0; i < 5; ++i) {
      CHECK(std::abs(half.last[i] - x[last[i]]) < 1e-12);
      c[i] = u(random), whole[last[i]] += c[i];
    }
    CHECK((A * linear.finish(half, c) - whole).norm() < 1e-11 * whole.norm());
  }
  std::fill(values.begin(), values.end(), 0.0);
  CHECK_FALSE(linear.factorize(values));
  CHECK_FALSE(linear.factorize_indefinite(values));
}

TEST_CASE(
    "with seconds increments are fractions of a stage, and those of a short stage grow into a long one") {
  LoadPathOptions options;
  options.seconds = 100;
  options.first = options.largest = 0.25;
  std::vector<double> reached;
  const auto attempt = [](double) {
    SolveReport r;
    r.outcome = Outcome::converged, r.iterations = 1;
    return r;
  };
  const auto accepted = [&](double t, double, double, const SolveReport&) {
    reached.push_back(t);
    return true;
  };
  REQUIRE(load_path(options, 0, {}, {0.001}, attempt, accepted).complete);
  CHECK(std::count_if(reached.begin(), reached.end(), [](double t) { return t <= 0.001; }) == 4);
  CHECK(reached[4] - reached[3] == near(0.00025));
  CHECK(reached[5] - reached[4] == near(1.5 * 0.00025));
  for (std::size_t i = 5; i < reached.size(); ++i)
    CHECK(reached[i] - reached[i - 1] <= 0.25 * 0.999 + 1e-12);
  reached.clear();
  options.steps = 5;
  REQUIRE(load_path(options, 0, {}, {0.001}, attempt, accepted).complete);
  REQUIRE(reached.size() == 10);
  CHECK(reached[4] == 0.001);
  CHECK(reached[7] == near(0.001 + 0.6 * 0.999));
}

TEST_CASE(
    "an increment of too large an error in time is begun again, and none is cut short for nothing") {
  LoadPathOptions options;
  options.seconds = 1, options.time_error = 1e-3;
  double from = 0, largest = 0;
  int attempts = 0;
  std::vector<double> taken;
  // the error of an increment is its third power, times something that fades
  const auto attempt = [&](double t) {
    SolveReport r;
    r.outcome = Outcome::converged, r.iterations = 1;
    r.time_error = 1e4 * std::exp(-20 * t) * std::pow(t - from, 3);
    REQUIRE(++attempts < 1000);
    return r;
  };
  const PathReport report = load_path(options, 0, {}, {}, attempt,
                                      [&](double t, double by, double, const SolveReport& r) {
                                        largest = std::max(largest, r.time_error);
                                        taken.push_back(by), from = t;
                                        return true;
                                      });
  REQUIRE(report.complete);
  CHECK(largest <= options.time_error);
  CHECK(largest > 0.2 * options.time_error);
  CHECK(report.too_long >= 1);
  CHECK(report.too_long < 10);
  CHECK(attempts == report.steps + report.too_long);
  CHECK(report.cut_backs == 0);
  CHECK(*std::max_element(taken.begin(), taken.end()) > 0.09);
}

TEST_CASE(
    "an increment that is a little too long for its error is not stretched to the end of its stage again") {
  LoadPathOptions options;
  options.seconds = 1, options.first = options.largest = 1, options.time_error = 1e-3;
  double from = 0;
  int attempts = 0;
  const auto attempt = [&](double t) {
    SolveReport r;
    r.outcome = ++attempts < 10 ? Outcome::converged : Outcome::singular;
    r.time_error = 1.2e-3 * std::pow(t - from, 3);
    return r;
  };
  const auto accepted = [&](double t, double, double, const SolveReport&) {
    from = t;
    return true;
  };
  const PathReport report = load_path(options, 0, {}, {}, attempt, accepted);
  CHECK(report.complete);
  CHECK(report.steps == 2);
}
