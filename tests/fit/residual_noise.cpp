// Residuals that are correlated along curves: what they count as, and that intervals hold what they
// say.
#include "identification/fit/residual_noise.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>

#include "core/base/student.hpp"
#include "identification/fit/identifiability.hpp"
#include "support/correlated.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

MatX dense(const ResidualNoise& n, Eigen::Index m) {
  MatX V = n.white * n.white * MatX::Identity(m, m);
  Eigen::Index at = 0;
  for (Eigen::Index size : n.curves) {
    for (Eigen::Index i = 0; i < size; ++i)
      for (Eigen::Index j = 0; j < size; ++j)
        V(at + i, at + j) +=
            n.deviation * n.deviation * std::pow(n.rho, static_cast<double>(std::abs(i - j)));
    at += size;
  }
  return V;
}

VecX normal(Eigen::Index n, Random& random) {
  VecX v(n);
  for (double& x : v) x = random.normal();
  return v;
}

VecX drawn(const std::vector<Eigen::Index>& curves, double rho, Random& random) {
  VecX e(0);
  for (Eigen::Index n : curves) {
    std::vector<double> one(static_cast<std::size_t>(n), 0.);
    test::add_noise(one, 1, rho, random);
    e.conservativeResize(e.size() + n);
    e.tail(n) = Eigen::Map<const VecX>(one.data(), n);
  }
  return e;
}

}  // namespace

TEST_CASE("Student's factor at 95 %") {
  for (const auto& [freedom, factor] :
       {std::pair{2., 4.303}, {3., 3.182}, {5., 2.571}, {10., 2.228}, {30., 2.042}, {120., 1.980}})
    CHECK(student_95(freedom) == near(factor, freedom < 4 ? 0.01 : 0.001));
  CHECK(student_95(std::numeric_limits<double>::infinity()) == near(1.959964, 1e-6));
}

TEST_CASE("covariance, variance along a direction and likelihood are those of the dense matrices") {
  Random random(4);
  ResidualNoise noise;
  noise.curves = {7, 1, 12}, noise.deviation = 0.3, noise.rho = 0.8, noise.white = 0.1;
  const MatX J = normal(60, random).reshaped(20, 3), V = dense(noise, 20),
             inverse = (J.transpose() * J).inverse();
  const MatX expected = inverse * J.transpose() * V * J * inverse;
  CHECK((covariance(J, {false, false, false}, noise) - expected).norm() <= 1e-12 * expected.norm());
  const MatX two = J.leftCols(2), inverse_2 = (two.transpose() * two).inverse();
  const MatX expected_2 = inverse_2 * two.transpose() * V * two * inverse_2,
             got = covariance(J, {false, false, true}, noise);
  CHECK((got.topLeftCorner(2, 2) - expected_2).norm() <= 1e-12 * expected_2.norm());
  CHECK(std::isnan(got(2, 2)));
  const VecX v = normal(20, random);
  CHECK(along(noise, v).variance == near(v.dot(V * v), 1e-12));
  // the factor is the ratio of the errors, and that of Student's factors, which is one for a noise
  // that is told
  const VecX factor = interval_factors(J, {false, false, false}, noise);
  for (int i = 0; i < 3; ++i)
    CHECK(factor[i] == near(std::sqrt(expected(i, i) / inverse(i, i)) / noise.total(), 1e-9));
  //   -2 ln L of the autoregression, with the deviation that is best for each rho
  const VecX r = drawn({7, 1, 12}, 0.8, random);
  double lowest = 1e300;
  for (int k = 0; k < 1000; ++k) {
    ResidualNoise unit = noise;
    unit.white = 0;
    unit.rho = (1 - 1. / 12) * k / 999;
    unit.deviation = 1;
    const MatX R = dense(unit, 20);
    const double of_rho = 20 * std::log(r.dot(R.inverse() * r) / 20) + std::log(R.determinant());
    CHECK(minus_two_log_likelihood(r, noise.curves, unit.rho) == near(of_rho, 1e-9));
    lowest = std::min(lowest, of_rho);
  }
  const double best = most_likely_correlation(r, noise.curves);
  CHECK(minus_two_log_likelihood(r, noise.curves, best) == near(lowest, 1e-4));
}

TEST_CASE("noise that a fit took a correlation out of is that of the dense matrices") {
  Random random(9);
  const std::vector<Eigen::Index> curves{7, 1, 12};
  ResidualNoise noise;
  noise.curves = curves;
  noise.deviation = 0.3;
  noise.rho = 0.8;
  const MatX R = dense(noise, 20) / (0.3 * 0.3);
  noise.removed = 0.7;
  MatX T = innovations(MatX::Identity(20, 20), curves, 0.7);
  const MatX V = 0.09 * T * R * T.transpose() / (1 - 0.64);
  const VecX v = normal(20, random);
  CHECK(along(noise, v).variance == near(v.dot(V * v), 1e-12));
  const MatX J = normal(60, random).reshaped(20, 3);
  const MatX inverse = (J.transpose() * J).inverse();
  const MatX expected = inverse * J.transpose() * V * J * inverse;
  CHECK((covariance(J, {false, false, false}, noise) - expected).norm() <= 1e-12 * expected.norm());
  // the operation and its inverse
  CHECK((from_innovations(T * v, curves, 0.7) - v).norm() <= 1e-12 * v.norm());
  // where both correlations agree, what is left is white
  noise.removed = 0.8;
  CHECK(along(noise, v).variance == near(0.09 * v.squaredNorm(), 1e-12));
}

TEST_CASE("correlation and size of known noise are found, whatever the parameters took from it") {
  const std::vector<Eigen::Index> curves{60, 60, 60, 60};
  MatX J(240, 4);
  for (int i = 0; i < 240; ++i)
    for (int j = 0; j < 4; ++j)
      J(i, j) = std::pow((i % 60 + 1) / 60., j + 1) * (i / 60 == j ? 2 : 1);
  const MatX hat = J * (J.transpose() * J).inverse() * J.transpose();
  for (double rho : {0., 0.3, 0.6, 0.9, 0.97}) {
    CAPTURE(rho);
    double mean_rho = 0, mean_square = 0;
    for (int seed = 0; seed < 60; ++seed) {
      Random random(8, static_cast<std::uint64_t>(seed));
      const VecX e = drawn(curves, rho, random), r = e - hat * e;
      const ResidualNoise n = residual_noise(r, J, curves, 1);
      mean_rho += n.rho / 60, mean_square += n.deviation * n.deviation / 60;
      if (n.rho == 0) CHECK(n.effective == 240);
    }
    CHECK(mean_rho == near(rho, 0.05, rho > 0 ? 0 : 0.05));
    CHECK(mean_square == near(1, rho > 0.95 ? 0.35 : 0.15));
  }
}

TEST_CASE(
    "the effective number: all of white values, (1 - rho)/(1 + rho) of long curves, one of a curve that is but one drift") {
  Random random(2);
  const std::vector<Eigen::Index> curves{20000};
  const ResidualNoise n = residual_noise(drawn(curves, 0.9, random), MatX(20000, 0), curves, 1);
  CHECK(n.rho == near(0.9, 0.02));
  CHECK(n.effective == near(20000 * (1 - n.rho) / (1 + n.rho), 0.01));
  const std::vector<Eigen::Index> short_ones(10, 30);
  const ResidualNoise drift =
      residual_noise(drawn(short_ones, 0.999, random), MatX(300, 0), short_ones, 1);
  CHECK(drift.effective >= 10);
  CHECK(drift.effective <= 20);
  // rounding of exact data is no noise
  CHECK(residual_noise(1e-7 * drawn(short_ones, 0.9, random), MatX(300, 0), short_ones, 1).rho ==
        0);
}

TEST_CASE("the bootstrap holds the estimate where residuals have a mean and a trend") {
  // y = p x fitted to curves that it cannot follow
  for (int seed = 0; seed < 30; ++seed) {
    Random random(31, static_cast<std::uint64_t>(seed));
    VecX x(40), y(40);
    const double offset = 2 * random.normal(), bend = random.normal();
    for (int i = 0; i < 40; ++i)
      x[i] = (i % 20 + 1) / 20.,
      y[i] = 3 * x[i] + offset + bend * x[i] * x[i] * (i < 20 ? 1 : 0.5) + 0.05 * random.normal();
    LeastSquares q;
    q.residual = [x, y](const VecX& p, VecX& r) {
      r = p[0] * x - y;
      return true;
    };
    q.start = q.typical = VecX::Ones(1), q.lower = VecX::Constant(1, -100), q.upper = -q.lower,
    q.size = y.norm();
    const LeastSquaresResult best = least_squares(q);
    const ResidualNoise noise = residual_noise(best.r, best.J, {20, 20}, 1);
    const Bootstrap b = bootstrap([&] { return q; }, best.p, noise, {.samples = 200});
    CAPTURE(seed);
    CHECK(b.failed == 0);
    CHECK(b.low[0] < best.p[0]);
    CHECK(b.high[0] > best.p[0]);
    // and is as wide as the standard error says
    const double error = std::sqrt(covariance(best.J, {false}, noise)(0, 0));
    CHECK(b.high[0] - b.low[0] == near(2 * 1.96 * error, 0.45));
  }
}

TEST_CASE("95 % intervals under correlated noise hold the true parameters 90 to 99 times of 100") {
  const FitProblem exact = test::protocols(30);
  constexpr int seeds = 200;
  for (double rho : {0., 0.5, 0.9}) {
    Eigen::VectorXi held = Eigen::VectorXi::Zero(5), held_white = held, held_by_profile = held;
    for (int seed = 0; seed < seeds; ++seed) {
      const FitProblem q = test::noisy(exact, 0.005 * test::largest_of(exact), rho,
                                       static_cast<std::uint64_t>(seed));
      const FitResult f = fit(q, {.starts = 1});
      REQUIRE(f.best.converged);
      const LeastSquares problem = least_squares_problem(q);
      const VecX factor = interval_factors(f.columns, f.left_out, f.noise);
      const MatX white = covariance(f.best);
      for (int i = 0; i < 5; ++i) {
        const double truth = q.free[static_cast<std::size_t>(i)].start,
                     off = std::abs(f.best.p[i] - truth);
        // error = (J_i beyond the others)^-1: white error times the factor, Student's included
        const double white_error = std::sqrt(covariance(
            f.best.J, f.left_out, white_noise(f.noise.deviation, f.best.r.size()))(i, i));
        held[i] += off <= 1.96 * factor[i] * white_error;
        held_white[i] += off <= 1.96 * std::sqrt(white(i, i));
        if (seed < 100)
          held_by_profile[i] +=
              profile_rise(problem, i, truth, f.best.p, f.noise.deviation * factor[i]) <= 3.8415;
      }
    }
    for (int i = 0; i < 5; ++i) {
      CAPTURE(rho);
      CAPTURE(i);
      CHECK(held[i] >= 0.90 * seeds);
      CHECK(held[i] <= 0.99 * seeds);
      CHECK(held_by_profile[i] >= 90);
      // independent values: what was believed before
      if (rho == 0.9) CHECK(held_white[i] <= 0.70 * seeds);
    }
  }
}
