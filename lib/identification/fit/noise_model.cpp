#include "identification/fit/noise_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "identification/fit/residual_noise.hpp"

namespace langer {

// Scales and correlation that make residuals alike and independent under a noise model.
Standardizer::Standardizer(VecX measured, std::vector<Eigen::Index> curves, std::vector<bool> rest,
                           NoiseModel noise)
    : measured_(std::move(measured)),
      curves_(std::move(curves)),
      rest_(std::move(rest)),
      noise_(noise) {
  const auto n = static_cast<double>(measured_.size());
  const double size = measured_.norm();
  if (size > 0) root_mean_square_ = size / std::sqrt(n);
  if (noise_.reference > 0) root_mean_square_ = noise_.reference;
  counted_ = std::count(rest_.begin(), rest_.end(), false);
}

// The relative deviation of each value, sqrt(1 - share + share f^2) with f the stress of the model
// over the reference, and its derivative. Their geometric mean scales the likelihood.
Standardizer::Scales Standardizer::scales(const VecX& e) const {
  const Eigen::Index n = e.size();
  Scales all;
  all.s = VecX::Ones(n);
  all.relative = VecX::Zero(n);
  if (noise_.share == 0) return all;
  double log_sum = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (rest_[static_cast<std::size_t>(i)]) continue;
    const double f = (e[i] + measured_[i]) / root_mean_square_;
    const double square = 1 - noise_.share + noise_.share * f * f;
    all.s[i] = std::sqrt(square);
    all.relative[i] = noise_.share * f / (square * root_mean_square_);
    log_sum += 0.5 * std::log(square);
  }
  if (counted_ > 0) all.mean = std::exp(log_sum / static_cast<double>(counted_));
  // What is zero by definition says nothing of how the noise grows: it weighs as the mean.
  for (Eigen::Index i = 0; i < n; ++i) {
    if (rest_[static_cast<std::size_t>(i)]) all.s[i] = all.mean;
  }
  return all;
}

double Standardizer::correlation_scale() const {
  const auto n = static_cast<double>(measured_.size());
  const auto curves = static_cast<double>(curves_.size());
  return std::exp(-0.5 * curves / n * std::log1p(-noise_.rho * noise_.rho));
}

// u of z, column by column
MatX Standardizer::uncorrelated(const MatX& z) const {
  if (noise_.rho == 0) return z;
  return correlation_scale() * innovations(z, curves_, noise_.rho);
}

VecX Standardizer::scaled(const VecX& e) const {
  const Scales all = scales(e);
  return all.mean * e.cwiseQuotient(all.s);
}

//   dz_i = (G/s_i) (de_i - e_i d ln s_i + e_i d ln G),   d ln s_i = relative_i df_i,  df = de
MatX Standardizer::scaled_slope(const VecX& e, const MatX& J) const {
  const Scales all = scales(e);
  if (noise_.share == 0) return J;
  const VecX own = VecX::Ones(e.size()) - e.cwiseProduct(all.relative);
  const VecX of_mean =
      J.transpose() * all.relative / static_cast<double>(std::max<Eigen::Index>(counted_, 1));
  MatX slope = own.asDiagonal() * J;
  for (Eigen::Index i = 0; i < e.size(); ++i) {
    if (!rest_[static_cast<std::size_t>(i)]) slope.row(i) += e[i] * of_mean.transpose();
  }
  return all.mean * all.s.cwiseInverse().asDiagonal() * slope;
}

VecX Standardizer::residual(const VecX& e) const { return uncorrelated(scaled(e)); }

MatX Standardizer::residual_slope(const VecX& e, const MatX& J) const {
  return uncorrelated(scaled_slope(e, J));
}

double Standardizer::normalisation(const VecX& e) const {
  return correlation_scale() * scales(e).mean;
}

double Standardizer::size(const VecX& e) const {
  const Scales all = scales(e);
  return uncorrelated(all.mean * measured_.cwiseQuotient(all.s)).norm();
}

// The least squares problem of the standardized residuals.
LeastSquares standardized(const LeastSquares& problem, const Standardizer& standardizer) {
  LeastSquares q = problem;
  q.residual = [problem, standardizer](const VecX& p, VecX& u) {
    VecX e;
    if (!problem.residual(p, e) || !e.allFinite()) return false;
    u = standardizer.residual(e);
    return true;
  };
  q.slope = [problem, standardizer](const VecX& p, MatX& J) {
    VecX e;
    MatX of_e;
    if (!problem.residual(p, e) || !e.allFinite() || !jacobian(problem, p, of_e)) return false;
    J = standardizer.residual_slope(e, of_e);
    return true;
  };
  q.cheap_slope = true;
  // moduli have a part in s
  if (standardizer.noise().share > 0) q.linear.clear();
  return q;
}

namespace {

// -2 ln L at the best sigma for e, with the correlation that is best for the share of `noise`
double with_best_correlation(const VecX& e, const VecX& measured,
                             const std::vector<Eigen::Index>& curves, const std::vector<bool>& rest,
                             NoiseModel& noise) {
  noise.rho = 0;
  if (noise.correlated()) {
    const VecX z = Standardizer(measured, curves, rest, noise).scaled(e);
    noise.rho = most_likely_correlation(z, curves);
  }
  return minus_two_log_likelihood(Standardizer(measured, curves, rest, noise).residual(e));
}

}  // namespace

// Maximises the likelihood over the share of proportional noise on a grid of its logarithm; the
// best correlation at each share follows by itself.
NoiseModel most_likely_noise(const VecX& e, const VecX& measured,
                             const std::vector<Eigen::Index>& curves, const std::vector<bool>& rest,
                             NoiseKind kind) {
  NoiseModel best;
  best.kind = kind;
  best.reference = measured.norm() / std::sqrt(static_cast<double>(measured.size()));
  const double reference = best.reference;
  double lowest = with_best_correlation(e, measured, curves, rest, best);
  if (!best.grows()) return best;
  // The floor 1 - share counts by its order of magnitude: x = lg(1 - share), from 0 to -4.
  const double end = std::log10(1 - largest_share);
  constexpr int steps = 24;
  int at = 0;
  const auto value = [&](double x, NoiseModel& noise) {
    noise.kind = kind;
    noise.reference = reference;
    if (x <= end) {
      noise.share = largest_share;
    } else {
      noise.share = 1 - std::pow(10, x);
    }
    return with_best_correlation(e, measured, curves, rest, noise);
  };
  for (int k = 1; k <= steps; ++k) {
    NoiseModel noise;
    const double found = value(end * k / steps, noise);
    if (found < lowest) {
      lowest = found;
      best = noise;
      at = k;
    }
  }
  // golden sections around the lowest point of the grid
  double low = end * std::min(at + 1, steps) / steps;
  double high = end * std::max(at - 1, 0) / steps;
  constexpr double golden = 0.6180339887498949;
  double left = high - golden * (high - low);
  double right = low + golden * (high - low);
  NoiseModel noise;
  double of_left = value(left, noise);
  double of_right = value(right, noise);
  while (high - low > 1e-9) {
    if (of_left < of_right) {
      high = right;
      right = left;
      of_right = of_left;
      left = high - golden * (high - low);
      of_left = value(left, noise);
    } else {
      low = left;
      left = right;
      of_left = of_right;
      right = low + golden * (high - low);
      of_right = value(right, noise);
    }
  }
  if (value(0.5 * (low + high), noise) < lowest) best = noise;
  return best;
}

double minus_two_log_likelihood(const VecX& u) {
  const auto n = static_cast<double>(u.size());
  return n * std::log(std::max(u.squaredNorm(), std::numeric_limits<double>::min()) / n);
}

}  // namespace langer
