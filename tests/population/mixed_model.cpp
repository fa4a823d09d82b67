#include "identification/population/mixed_model.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "core/base/random.hpp"
#include "identification/population/chi_square.hpp"
#include "identification/population/link.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// y = phi_1 + phi_2 x at x = 0 .. m - 1, linear in phi: the likelihood has a closed form.
MixedSpecimen straight_line(const VecX& y) {
  MatX X(y.size(), 2);
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    X(k, 0) = 1;
    X(k, 1) = static_cast<double>(k);
  }
  MixedSpecimen one;
  one.design = MatX::Identity(2, 2);
  one.residual = [X, y](const VecX& phi, VecX& u, MatX* slope) {
    u = X * phi - y;
    if (slope) *slope = X;
    return true;
  };
  return one;
}

// y = phi_1 exp(-exp(phi_2) x)
MixedSpecimen decay(const VecX& x, const VecX& y) {
  MixedSpecimen one;
  one.design = MatX::Identity(2, 2);
  one.residual = [x, y](const VecX& phi, VecX& u, MatX* slope) {
    const double rate = std::exp(phi[1]);
    const VecX e = (-rate * x).array().exp();
    u = phi[0] * e - y;
    if (slope) {
      slope->resize(x.size(), 2);
      slope->col(0) = e;
      slope->col(1) = -phi[0] * rate * x.cwiseProduct(e);
    }
    return u.allFinite();
  };
  return one;
}

MixedState start_of(const VecX& beta, const VecX& variance, double sigma) {
  MixedState start;
  start.beta = beta;
  start.omega = variance.asDiagonal();
  start.sigma = sigma;
  return start;
}

}  // namespace

TEST_CASE("a balanced one-way layout has the estimates of the textbook") {
  // y_ik = mu + b_i + e_ik with n specimens of m values: maximum likelihood is
  //   sigma^2 = SSW / (n (m - 1)),   omega = (SSB / n - sigma^2) / m
  constexpr int n = 12;
  constexpr int m = 5;
  Random random(7);
  std::vector<MixedSpecimen> specimens;
  std::vector<double> means;
  double within = 0;
  for (int i = 0; i < n; ++i) {
    VecX y(m);
    const double level = 3 + 0.5 * random.normal();
    for (double& value : y) value = level + 0.2 * random.normal();
    means.push_back(y.mean());
    within += (y.array() - y.mean()).matrix().squaredNorm();
    MixedSpecimen one;
    one.design = MatX::Ones(1, 1);
    one.residual = [y](const VecX& phi, VecX& u, MatX* slope) {
      u = VecX::Constant(y.size(), phi[0]) - y;
      if (slope) *slope = MatX::Ones(y.size(), 1);
      return true;
    };
    specimens.push_back(one);
  }
  double mean = 0;
  for (const double one : means) mean += one / n;
  double between = 0;
  for (const double one : means) between += m * (one - mean) * (one - mean);
  const double variance = within / (n * (m - 1));
  const double omega = (between / n - variance) / m;
  const MixedResult found =
      fit_mixed_model(specimens, start_of(VecX::Ones(1), VecX::Ones(1), 1), {});
  REQUIRE(found.converged);
  CHECK(found.beta[0] == near(mean, 1e-10));
  CHECK(found.sigma * found.sigma == near(variance, 1e-7));
  CHECK(found.omega(0, 0) == near(omega, 1e-6));
  CHECK(found.beta_covariance(0, 0) == near((variance / m + omega) / n, 1e-6));
  const double pi = 3.14159265358979323846;
  const double determinant = (m - 1) * std::log(variance) + std::log(variance + m * omega);
  CHECK(found.minus_two_log_likelihood ==
        near(n * (determinant + m * std::log(2 * pi)) + n * m, 1e-9));
}

TEST_CASE("the posterior of a balanced one-way layout is that of its closed form") {
  // With beta integrated, p(omega, sigma) of n specimens of m values has with v = omega^2 +
  // sigma^2/m
  //   -n (m - 1) ln sigma - SSW / (2 sigma^2) - (n - 1)/2 ln v - SSB / (2 v),   flat in omega, ln sigma
  constexpr int n = 10;
  constexpr int m = 4;
  Random random(11);
  std::vector<MixedSpecimen> specimens;
  std::vector<double> means;
  double within = 0;
  for (int i = 0; i < n; ++i) {
    VecX y(m);
    const double level = 3 + 0.5 * random.normal();
    for (double& value : y) value = level + 0.4 * random.normal();
    means.push_back(y.mean());
    within += (y.array() - y.mean()).matrix().squaredNorm();
    MixedSpecimen one;
    one.design = MatX::Ones(1, 1);
    one.residual = [y](const VecX& phi, VecX& u, MatX* slope) {
      u = VecX::Constant(y.size(), phi[0]) - y;
      if (slope) *slope = MatX::Ones(y.size(), 1);
      return true;
    };
    specimens.push_back(one);
  }
  double mean = 0;
  for (const double one : means) mean += one / n;
  double between = 0;
  for (const double one : means) between += (one - mean) * (one - mean);

  // sums over a grid of omega and ln sigma
  double sum = 0, of_omega = 0, of_square = 0, of_beta = 0, of_sigma = 0;
  for (int i = 0; i < 400; ++i)
    for (int k = 0; k < 200; ++k) {
      const double omega = 0.005 * (i + 0.5);
      const double log_sigma = std::log(0.4) + 0.005 * (k - 100);
      const double variance = std::exp(2 * log_sigma);
      const double v = omega * omega + variance / m;
      const double p = std::exp(-n * (m - 1) * log_sigma - within / (2 * variance) -
                                0.5 * (n - 1) * std::log(v) - between / (2 * v));
      sum += p;
      of_omega += p * omega;
      of_square += p * omega * omega;
      of_beta += p * v / n;
      of_sigma += p * std::exp(log_sigma);
    }
  const double expected = of_omega / sum;
  const double deviation = std::sqrt(of_square / sum - expected * expected);

  const MixedResult found =
      fit_mixed_model(specimens, start_of(VecX::Ones(1), VecX::Ones(1), 1), {});
  REQUIRE(found.converged);
  PosteriorConfig config;
  config.samples = 4000;
  const MixedDraws draws = mixed_posterior(specimens, found, {}, config, 1);
  // about 1500 independent samples: four standard errors
  CHECK(draws.deviations.mean() == near(expected, 0, 0.1 * deviation));
  const double second = draws.deviations.array().square().mean();
  CHECK(std::sqrt(second - std::pow(draws.deviations.mean(), 2)) == near(deviation, 0.15));
  CHECK(draws.beta.mean() == near(mean, 0, 0.1 * std::sqrt(of_beta / sum)));
  const double spread = (draws.beta.array() - draws.beta.mean()).square().mean();
  CHECK(spread == near(of_beta / sum, 0.15));
  CHECK(draws.sigma.mean() == near(of_sigma / sum, 0.02));
}

TEST_CASE("a scatter that is not there ends at zero, not in a failure") {
  Random random(3);
  std::vector<MixedSpecimen> specimens;
  for (int i = 0; i < 15; ++i) {
    VecX y(8);
    for (Eigen::Index k = 0; k < 8; ++k)
      y[k] = 2 + 0.5 * static_cast<double>(k) + 0.3 * random.normal();
    specimens.push_back(straight_line(y));
  }
  const MixedResult found =
      fit_mixed_model(specimens, start_of(VecX::Ones(2), VecX::Constant(2, 0.1), 0.5), {});
  REQUIRE(found.converged);
  CHECK(found.omega(1, 1) < 1e-3);
  CHECK(found.sigma == near(0.3, 0.15));
}

TEST_CASE("population, scatter and noise of a nonlinear model are found again") {
  VecX x(10);
  for (Eigen::Index k = 0; k < 10; ++k) x[k] = 0.4 * static_cast<double>(k);
  Random random(11);
  constexpr int n = 200;
  constexpr double rho = 0.8;
  std::vector<MixedSpecimen> specimens;
  for (int i = 0; i < n; ++i) {
    const double z1 = random.normal();
    const double z2 = random.normal();
    const double height = 2 + 0.4 * z1;
    const double rate = std::exp(-0.5 + 0.3 * (rho * z1 + std::sqrt(1 - rho * rho) * z2));
    VecX y(10);
    for (Eigen::Index k = 0; k < 10; ++k)
      y[k] = height * std::exp(-rate * x[k]) + 0.05 * random.normal();
    specimens.push_back(decay(x, y));
  }
  VecX beta(2);
  beta << 1.5, 0;
  VecX variance(2);
  variance << 0.3, 0.3;
  MixedOptions options;
  const MixedResult found = fit_mixed_model(specimens, start_of(beta, variance, 0.1), options);
  REQUIRE(found.converged);
  // within four standard errors of what the data were made of
  const VecX error = found.beta_covariance.diagonal().cwiseSqrt();
  CHECK(std::abs(found.beta[0] - 2) < 4 * error[0]);
  CHECK(std::abs(found.beta[1] + 0.5) < 4 * error[1]);
  CHECK(std::abs(std::log(std::sqrt(found.omega(0, 0)) / 0.4)) < 4 * found.log_deviation_error[0]);
  CHECK(std::abs(std::log(std::sqrt(found.omega(1, 1)) / 0.3)) < 4 * found.log_deviation_error[1]);
  const double correlation = found.omega(1, 0) / std::sqrt(found.omega(0, 0) * found.omega(1, 1));
  CHECK(std::abs(std::atanh(correlation) - std::atanh(rho)) < 4 * found.correlation_error(1, 0));
  CHECK(found.sigma == near(0.05, 0.05));

  SUBCASE("whatever the number of threads") {
    options.threads = 3;
    const MixedResult other = fit_mixed_model(specimens, start_of(beta, variance, 0.1), options);
    CHECK(other.beta == found.beta);
    CHECK(other.omega == found.omega);
  }
  SUBCASE("errors of a scatter are those of a sample of normal numbers where each is well known") {
    CHECK(found.log_deviation_error[0] == near(1 / std::sqrt(2. * n), 0.1));
    CHECK(found.correlation_error(1, 0) == near(1 / std::sqrt(1. * n), 0.2));
  }
}

TEST_CASE("an effect of a covariate is separated from the scatter") {
  Random random(5);
  std::vector<MixedSpecimen> specimens;
  for (int i = 0; i < 60; ++i) {
    const double group = i % 2;
    VecX y(6);
    const double level = 1 + 0.7 * group + 0.2 * random.normal();
    for (double& value : y) value = level + 0.1 * random.normal();
    MixedSpecimen one = straight_line(y);
    one.design = MatX::Zero(2, 3);
    one.design(0, 0) = 1;
    one.design(1, 1) = 1;
    one.design(0, 2) = group;
    specimens.push_back(one);
  }
  MixedOptions options;
  options.varies = {true, false};
  const MixedResult found =
      fit_mixed_model(specimens, start_of(VecX::Zero(3), VecX::Constant(2, 0.1), 0.2), options);
  REQUIRE(found.converged);
  CHECK(std::abs(found.beta[2] - 0.7) < 4 * std::sqrt(found.beta_covariance(2, 2)));
  CHECK(found.omega.row(1).isZero(0));
  CHECK(std::sqrt(found.omega(0, 0)) == near(0.2, 0.3));
}

TEST_CASE("links and their slopes agree, and lead back") {
  for (const Link& link :
       {Link{LinkKind::identity}, Link{LinkKind::log}, Link{LinkKind::logit, 0, 1. / 3}}) {
    for (const double x : {0.01, 0.1, 0.3}) {
      const double phi = link.forward(x);
      CHECK(link.backward(phi) == near(x, 1e-12));
      const double h = 1e-6;
      const double slope = (link.backward(phi + h) - link.backward(phi - h)) / (2 * h);
      CHECK(link.slope(phi) == near(slope, 1e-8));
    }
  }
}

TEST_CASE("tails of chi-square are those of tables") {
  CHECK(chi_square_beyond(3.841458820694124, 1) == near(0.05, 1e-12));
  CHECK(chi_square_beyond(5.991464547107979, 2) == near(0.05, 1e-12));
  CHECK(chi_square_beyond(18.307038053275146, 10) == near(0.05, 1e-12));
  CHECK(chi_square_beyond(2, 2) == near(std::exp(-1.), 1e-13));
}
