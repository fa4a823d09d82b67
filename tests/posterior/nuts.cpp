#include "identification/posterior/nuts.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

#include "core/base/quantile.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

std::vector<NutsChain> chains_of(const LogDensity& density, const VecX& start, const MatX& scale,
                                 int samples) {
  std::vector<NutsChain> chains;
  for (int c = 0; c < 4; ++c) {
    NutsOptions options;
    options.samples = samples;
    options.chain = static_cast<std::uint64_t>(c);
    chains.push_back(sample_chain(density, start, scale, options));
  }
  return chains;
}

std::vector<VecX> columns_of(const std::vector<NutsChain>& chains, Eigen::Index j) {
  std::vector<VecX> columns;
  for (const NutsChain& chain : chains) columns.push_back(chain.draws.col(j));
  return columns;
}

double mean_of(const std::vector<VecX>& columns) {
  double sum = 0;
  for (const VecX& column : columns) sum += column.mean();
  return sum / static_cast<double>(columns.size());
}

}  // namespace

TEST_CASE("samples of a correlated normal density have its moments") {
  MatX C(3, 3);
  C << 1, 0.95, 0, 0.95, 1, 0, 0, 0, 100;
  const MatX H = C.inverse();
  const LogDensity density = [&](const VecX& x, VecX& g) {
    g = -H * x;
    return -0.5 * x.dot(H * x);
  };
  const auto chains = chains_of(density, VecX::Ones(3), MatX::Identity(3, 3), 1500);
  for (Eigen::Index j = 0; j < 3; ++j) {
    const auto columns = columns_of(chains, j);
    const Convergence c = convergence(columns);
    CHECK(c.r_hat < 1.01);
    CHECK(c.effective > 1500);
    // four standard errors of a mean and of a variance of so many independent samples
    const double deviation = std::sqrt(C(j, j));
    CHECK(std::abs(mean_of(columns)) < 4 * deviation / std::sqrt(c.effective));
    double square = 0;
    for (const VecX& column : columns) square += column.squaredNorm() / 6000;
    CHECK(std::abs(square / C(j, j) - 1) < 4 * std::sqrt(2 / c.effective) * 1.5);
  }
  double product = 0;
  for (const NutsChain& chain : chains)
    product += chain.draws.col(0).dot(chain.draws.col(1)) / 6000;
  CHECK(product == near(0.95, 0.1));
}

TEST_CASE("samples of a skewed density have its quantiles") {
  // x = ln y, y of a gamma distribution of shape 3: p(x) ~ exp(3 x - exp(x))
  const LogDensity density = [](const VecX& x, VecX& g) {
    g = VecX::Constant(1, 3 - std::exp(x[0]));
    return 3 * x[0] - std::exp(x[0]);
  };
  const auto chains = chains_of(density, VecX::Zero(1), MatX::Identity(1, 1), 3000);
  std::vector<double> y;
  for (const NutsChain& chain : chains)
    for (Eigen::Index i = 0; i < chain.draws.rows(); ++i) y.push_back(std::exp(chain.draws(i, 0)));
  std::sort(y.begin(), y.end());
  // quantiles of the gamma distribution; 12000 samples know a probability to 0.005
  const auto below = [](double x) {
    return 1 - std::exp(-x) * (1 + x + x * x / 2);
  };
  CHECK(below(quantile(y, 0.025)) == near(0.025, 0, 0.008));
  CHECK(below(quantile(y, 0.5)) == near(0.5, 0, 0.025));
  CHECK(below(quantile(y, 0.975)) == near(0.975, 0, 0.008));
}

TEST_CASE("a seed decides the samples, and chains differ") {
  const LogDensity density = [](const VecX& x, VecX& g) {
    g = -x;
    return -0.5 * x.squaredNorm();
  };
  NutsOptions options;
  options.samples = 50;
  const MatX I = MatX::Identity(2, 2);
  const NutsChain one = sample_chain(density, VecX::Zero(2), I, options);
  const NutsChain again = sample_chain(density, VecX::Zero(2), I, options);
  options.chain = 1;
  const NutsChain other = sample_chain(density, VecX::Zero(2), I, options);
  CHECK(one.draws == again.draws);
  CHECK(one.draws != other.draws);
}

TEST_CASE("chains that stay apart are not taken for one distribution") {
  std::vector<VecX> chains;
  for (int c = 0; c < 4; ++c) {
    VecX x(100);
    for (Eigen::Index i = 0; i < 100; ++i)
      x[i] = 5 * c + std::sin(37.7 * static_cast<double>(i * i));
    chains.push_back(x);
  }
  CHECK(convergence(chains).r_hat > 2);
  CHECK(convergence(chains).effective < 20);
}

TEST_CASE("correlated samples count as fewer") {
  // x_i = 0.9 x_(i-1) + e_i: effective number n (1 - 0.9) / (1 + 0.9)
  std::vector<VecX> chains;
  std::uint64_t state = 12345;
  const auto uniform = [&] {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<double>(state >> 11) * 0x1p-53;
  };
  for (int c = 0; c < 4; ++c) {
    VecX x(4000);
    x[0] = 0;
    for (Eigen::Index i = 1; i < x.size(); ++i) {
      double e = -6;
      for (int k = 0; k < 12; ++k) e += uniform();
      x[i] = 0.9 * x[i - 1] + e;
    }
    chains.push_back(x);
  }
  CHECK(convergence(chains).effective == near(16000 * 0.1 / 1.9, 0.2));
}

TEST_CASE("paths are reflected at walls: a normal density that ends in its middle") {
  // correlated by 0.99, cut at 0 and at 1 in the first number
  MatX C(2, 2);
  C << 1, 0.99, 0.99, 1;
  const MatX H = C.inverse();
  const LogDensity density = [&](const VecX& x, VecX& g) {
    g = -H * x;
    return -0.5 * x.dot(H * x);
  };
  std::vector<VecX> first, second;
  for (int c = 0; c < 4; ++c) {
    NutsOptions options;
    options.samples = 4000;
    options.chain = static_cast<std::uint64_t>(c);
    options.lower = VecX{{0, -INFINITY}};
    options.upper = VecX{{1, INFINITY}};
    const NutsChain chain = sample_chain(density, VecX{{0.5, 0.5}}, C, options);
    CHECK(chain.divergences == 0);
    CHECK(chain.draws.col(0).minCoeff() >= 0);
    CHECK(chain.draws.col(0).maxCoeff() <= 1);
    first.push_back(chain.draws.col(0));
    second.push_back(chain.draws.col(1));
  }
  // mean of a standard normal number between 0 and 1: (phi(0) - phi(1)) / (Phi(1) - Phi(0))
  const double mean = (0.3989423 - 0.2419707) / 0.3413447;
  const Convergence c = convergence(first);
  CHECK(c.r_hat < 1.01);
  CHECK(c.effective > 2000);
  CHECK(std::abs(mean_of(first) - mean) < 4 * 0.29 / std::sqrt(c.effective));
  CHECK(std::abs(mean_of(second) - 0.99 * mean) <
        4 * 0.33 / std::sqrt(convergence(second).effective));
}
