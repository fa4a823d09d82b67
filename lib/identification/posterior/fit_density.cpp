#include "identification/posterior/fit_density.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/traps.hpp"
#include "core/tensor/dense.hpp"

namespace langer {

double FreeNumber::number(double x) const {
  if (walls) return x;
  const NoTraps may_be_infinite;
  if (below && above) return lower + (upper - lower) / (1 + std::exp(-x));
  if (below) return lower + std::exp(x);
  if (above) return upper - std::exp(-x);
  return x;
}

double FreeNumber::slope(double x) const {
  if (walls) return 1;
  if (below && above) {
    const double e = std::exp(-std::abs(x));
    return (upper - lower) * e / ((1 + e) * (1 + e));
  }
  if (below) return std::exp(x);
  if (above) return std::exp(-x);
  return 1;
}

double FreeNumber::curvature(double x) const {
  if (walls) return 0;
  if (below && above) return -std::tanh(0.5 * x);
  if (below) return 1;
  if (above) return -1;
  return 0;
}

double FreeNumber::place(double p) const {
  if (walls) return p;
  if (below && above) {
    const double share = std::clamp((p - lower) / (upper - lower), 1e-6, 1 - 1e-6);
    return std::log(share / (1 - share));
  }
  if (below) return std::log(std::max(p - lower, 1e-9));
  if (above) return -std::log(std::max(upper - p, 1e-9));
  return p;
}

FitDensity::FitDensity(const FitProblem& problem, const FitResult& fit)
    : model_(likelihood_problem(problem, fit)), estimate_(fit.best.p) {
  known_noise_ = problem.further != nullptr;
  for (Eigen::Index i = 0; i < model_.lower.size(); ++i) {
    FreeNumber one;
    // an angle that comes again has no bounds
    if (!(model_.period_of(i) > 0)) {
      one.lower = model_.lower[i];
      one.upper = model_.upper[i];
      one.below = std::isfinite(one.lower);
      one.above = std::isfinite(one.upper);
    }
    free_.push_back(one);
  }
  set_walls();
}

// J^T J of the tests in units of their noise, by the parameters
bool FitDensity::curvature_of_tests(const VecX& p, MatX& H) {
  VecX u;
  MatX J;
  if (!model_.residual(p, u) || !jacobian(model_, p, J)) return false;
  const auto freedom = std::max(1., static_cast<double>(u.size() - p.size()));
  double variance = std::max(u.squaredNorm() / freedom, 1e-300);
  if (known_noise_) variance = 1;
  H = J.transpose() * J / variance;
  return true;
}

// A bound is probable where it lies within three standard errors of the estimate, all other
// parameters free. The variance of a number that the tests do not know is that of its box.
void FitDensity::set_walls() {
  constexpr double near = 3;
  MatX H;
  if (!curvature_of_tests(estimate_, H)) return;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    double width = std::max(std::abs(estimate_[k]), 1e-3);
    if (free_[i].below && free_[i].above) width = free_[i].upper - free_[i].lower;
    H(k, k) += 12 / (width * width);
  }
  const MatX C = Cholesky(H).inverse();
  for (std::size_t i = 0; i < free_.size(); ++i) {
    FreeNumber& one = free_[i];
    const auto k = static_cast<Eigen::Index>(i);
    const double reach = near * std::sqrt(C(k, k));
    const bool at_lower = one.below && estimate_[k] - reach < one.lower;
    const bool at_upper = one.above && estimate_[k] + reach > one.upper;
    one.walls = at_lower || at_upper;
  }
}

VecX FitDensity::lower_walls() const {
  VecX walls = VecX::Constant(estimate_.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < free_.size(); ++i)
    if (free_[i].walls && free_[i].below) walls[static_cast<Eigen::Index>(i)] = free_[i].lower;
  return walls;
}

VecX FitDensity::upper_walls() const {
  VecX walls = VecX::Constant(estimate_.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < free_.size(); ++i)
    if (free_[i].walls && free_[i].above) walls[static_cast<Eigen::Index>(i)] = free_[i].upper;
  return walls;
}

VecX FitDensity::numbers(const VecX& x) const {
  VecX p(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i)
    p[i] = free_[static_cast<std::size_t>(i)].number(x[i]);
  return p;
}

VecX FitDensity::place(const VecX& p) const {
  VecX x(p.size());
  for (Eigen::Index i = 0; i < p.size(); ++i) x[i] = free_[static_cast<std::size_t>(i)].place(p[i]);
  return x;
}

void FitDensity::turn_to_estimate(VecX& p) const {
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    const double period = model_.period_of(i);
    if (period > 0) p[i] -= period * std::round((p[i] - estimate_[i]) / period);
  }
}

double FitDensity::of_residual(const VecX& u) const {
  const double square = u.squaredNorm();
  if (known_noise_) return -0.5 * square;
  return -0.5 * static_cast<double>(u.size()) * std::log(square);
}

double FitDensity::of_parameters(const VecX& p) {
  VecX u;
  if (!p.allFinite() || !model_.residual(p, u) || !u.allFinite())
    return -std::numeric_limits<double>::infinity();
  return of_residual(u);
}

double FitDensity::log_slope(const VecX& x) const {
  double sum = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double slope = free_[static_cast<std::size_t>(i)].slope(x[i]);
    // so far out that the parameter is at its bound to the last digit
    if (!(slope > 0)) return -std::numeric_limits<double>::infinity();
    sum += std::log(slope);
  }
  return sum;
}

VecX FitDensity::between_walls(const VecX& x) const {
  return x.cwiseMax(lower_walls()).cwiseMin(upper_walls());
}

double FitDensity::operator()(const VecX& x, VecX& gradient) {
  gradient = VecX::Zero(x.size());
  const VecX p = numbers(x);
  VecX u;
  MatX J;
  if (!p.allFinite() || !model_.residual(p, u) || !u.allFinite() || !jacobian(model_, p, J))
    return -std::numeric_limits<double>::infinity();
  double factor = -1;
  if (!known_noise_) factor = -static_cast<double>(u.size()) / u.squaredNorm();
  gradient = factor * (J.transpose() * u);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeNumber& one = free_[static_cast<std::size_t>(i)];
    gradient[i] = gradient[i] * one.slope(x[i]) + one.curvature(x[i]);
  }
  return of_residual(u) + log_slope(x);
}

MatX FitDensity::scale(const VecX& x) {
  const auto k = x.size();
  MatX H;
  if (!curvature_of_tests(numbers(x), H)) return MatX::Identity(k, k);
  VecX slope(k);
  for (Eigen::Index i = 0; i < k; ++i) slope[i] = free_[static_cast<std::size_t>(i)].slope(x[i]);
  H = slope.asDiagonal() * H * slope.asDiagonal();
  for (Eigen::Index i = 0; i < k; ++i) {
    const FreeNumber& one = free_[static_cast<std::size_t>(i)];
    // of the logistic distribution, which is what a flat prior in a box is on the scale of the
    // logit
    double own = 0.3;
    // an angle of symmetry has no curvature to first order
    if (!one.below && !one.above) own = 1 / (15. * 15.);
    if (one.walls && one.below && one.above) {
      own = 12 / ((one.upper - one.lower) * (one.upper - one.lower));
    } else if (one.walls) {
      own = 1e-6 * H(i, i);
    }
    H(i, i) += own;
  }
  return Cholesky(H).inverse();
}

}  // namespace langer
