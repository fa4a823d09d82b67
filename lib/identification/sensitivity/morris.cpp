#include "identification/sensitivity/morris.hpp"

#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/in_order.hpp"
#include "core/base/random.hpp"

namespace langer {

namespace {

// Elementary effects of one trajectory (k, m). It moves one parameter after the other by Delta, in
// random order. Empty if a curve on the way does not exist.
MatX trajectory(const ParametricCurve& phi, const VecX& lower, const VecX& upper, int levels,
                Random random) {
  const auto k = lower.size();
  const int half = levels / 2;
  const double Delta = half / (levels - 1.);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(k));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  // each parameter starts in the lower half and goes up, or in the upper half and goes down
  VecX x(k), to(k);
  for (Eigen::Index i = 0; i < k; ++i) {
    x[i] = static_cast<double>(random.below(static_cast<std::uint64_t>(half))) / (levels - 1.);
    to[i] = x[i] + Delta;
    if (random.below(2)) std::swap(x[i], to[i]);
  }
  const auto at = [&](VecX& y) {
    return phi(lower + x.cwiseProduct(upper - lower), y) && y.allFinite();
  };
  MatX effects;
  VecX before, after;
  if (!at(before)) return {};
  effects.resize(k, before.size());
  for (Eigen::Index i : order) {
    const double moved = to[i] - x[i];
    x[i] = to[i];
    if (!at(after)) return {};
    effects.row(i) = (after - before) / moved;
    before.swap(after);
  }
  return effects;
}

// Mean, mean size and standard deviation of the effects, each (k, m).
struct Moments {
  MatX mu, mu_star, sigma;
};

template <class Pick>
// Moments over the trajectories that pick(0), pick(1), ... choose: all of them, or a bootstrap
// sample.
Moments moments(const std::vector<MatX>& all, Pick pick) {
  Moments m;
  const auto n = static_cast<double>(all.size());
  m.mu = m.mu_star = m.sigma = MatX::Zero(all[0].rows(), all[0].cols());
  for (std::size_t r = 0; r < all.size(); ++r) {
    m.mu += all[pick(r)] / n;
    m.mu_star += all[pick(r)].cwiseAbs() / n;
  }
  for (std::size_t r = 0; r < all.size(); ++r)
    m.sigma += (all[pick(r)] - m.mu).cwiseAbs2() / (n - 1);
  m.sigma = m.sigma.cwiseSqrt();
  return m;
}

// Means over the points of each group; NaN for an empty group.
MatX means(const MatX& A, const std::vector<std::vector<int>>& groups) {
  MatX result = MatX::Zero(A.rows(), static_cast<Eigen::Index>(groups.size()));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (int point : groups[g]) result.col(static_cast<Eigen::Index>(g)) += A.col(point);
    result.col(static_cast<Eigen::Index>(g)) /=
        static_cast<double>(groups[g].size());  // NaN in an empty group
  }
  return result;
}

}  // namespace

Morris morris(const CurveMaker& maker, const VecX& lower, const VecX& upper, int trajectories,
              int levels, const SamplingOptions& options) {
  Morris result;
  std::vector<MatX> all;
  const int threads = std::max(1, std::min(options.threads, trajectories));
  std::vector<ParametricCurve> phi;
  for (int t = 0; t < threads; ++t) phi.push_back(maker());
  std::vector<MatX> fresh(static_cast<std::size_t>(threads));
  in_order(
      threads, trajectories,
      [&](int worker, int r) {
        const auto w = static_cast<std::size_t>(worker);
        fresh[w] = trajectory(phi[w], lower, upper, levels,
                              Random(options.seed, static_cast<std::uint64_t>(r)));
      },
      [&](int worker, int r) {
        MatX& effects = fresh[static_cast<std::size_t>(worker)];
        if (effects.size())
          all.push_back(std::move(effects));
        else
          ++result.without_curve;
        if (options.progress) options.progress((r + 1.) / trajectories);
      });
  result.trajectories = static_cast<int>(all.size());
  if (all.size() < 2) return result;
  const Moments best = moments(all, [](std::size_t r) { return r; });
  // Intervals by the bootstrap: whole trajectories are drawn with replacement.
  Resamples mu, mu_star, sigma, group_mu_star, group_sigma;
  for (int b = 0; b < options.resamples; ++b) {
    Random random(options.seed, (1ull << 40) + static_cast<std::uint64_t>(b));
    std::vector<std::size_t> picked(all.size());
    for (std::size_t& p : picked) p = random.below(all.size());
    const Moments one = moments(all, [&](std::size_t r) { return picked[r]; });
    mu.add(one.mu);
    mu_star.add(one.mu_star);
    sigma.add(one.sigma);
    group_mu_star.add(means(one.mu_star, options.groups));
    group_sigma.add(means(one.sigma, options.groups));
  }
  result.mu = mu.around(best.mu);
  result.mu_star = mu_star.around(best.mu_star);
  result.sigma = sigma.around(best.sigma);
  result.group_mu_star = group_mu_star.around(means(best.mu_star, options.groups));
  result.group_sigma = group_sigma.around(means(best.sigma, options.groups));
  return result;
}

}  // namespace langer
