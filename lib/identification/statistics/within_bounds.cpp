#include "identification/statistics/within_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/no_number.hpp"
#include "core/base/random.hpp"
#include "core/tensor/dense.hpp"
#include "identification/fit/bounded_linear.hpp"

namespace langer {

namespace {

constexpr double normal_95 = 1.959963984540054;
constexpr int draws = 1000;

// J d + r by a triangle with as many rows as columns, and what no d can change; columns of length
// 1, and held by 1e-8 of that where the data do not feel a combination
struct Reduced {
  MatX A;
  VecX b, size;
  Reduced(const MatX& J, const VecX& r) {
    const Eigen::Index n = J.cols();
    size = J.colwise().norm().transpose();
    for (double& one : size)
      if (one == 0) one = 1;
    const Qr qr(J * size.cwiseInverse().asDiagonal());
    const Eigen::Index k = std::min(J.rows(), n);
    A = MatX::Zero(k + n, n);
    b = VecX::Zero(k + n);
    A.topRows(k) = qr.R();
    A.bottomRows(n) = 1e-8 * MatX::Identity(n, n);
    b.head(k) = -qr.Q_transposed_times(r).head(k);
  }
  // in a box of d: the answer, in units of `size`
  VecX solve(const VecX& to, const VecX& lower, const VecX& upper) const {
    return bounded_linear(A, to, lower.cwiseProduct(size), upper.cwiseProduct(size));
  }
  double square(const VecX& z) const { return (A * z - b).squaredNorm(); }
};

// The end of an interval on one side: where the linearised chi-square, with the other parameters
// following inside their bounds, has risen by half^2. Bracketing, then bisection.
double end_of(const Reduced& reduced, const VecX& lower, const VecX& upper, Eigen::Index of,
              double half, int side) {
  const double bound = side < 0 ? lower[of] : upper[of];
  const double least = reduced.b.squaredNorm();
  const auto rise = [&](double x) {
    VecX low = lower;
    VecX high = upper;
    low[of] = high[of] = x;
    return reduced.square(reduced.solve(reduced.b, low, high)) - least;
  };
  double in = 0;
  double out = side * half / reduced.size[of];
  while (std::abs(out) < std::abs(bound) && rise(out) < half * half) {
    in = out;
    out *= 2;
    if (std::abs(out) > 1e12 * half / reduced.size[of]) return side * inf;  // nothing feels it
  }
  if (std::abs(out) >= std::abs(bound)) {
    if (!std::isfinite(bound) || rise(bound) <= half * half) return bound;
    out = bound;
  }
  for (int k = 0; k < 60 && std::abs(out - in) > 1e-9 * std::abs(out); ++k) {
    const double middle = 0.5 * (in + out);
    if (rise(middle) <= half * half) {
      in = middle;
    } else {
      out = middle;
    }
  }
  return in;
}

// Second moments of the estimate by sampling: q ~ N(0, covariance), put into the box by the linear
// least squares problem.
MatX moments_of(const Reduced& reduced, const VecX& lower, const VecX& upper,
                const MatX& covariance) {
  const Eigen::Index n = lower.size();
  const MatX root = covariance_root(covariance);
  MatX sum = MatX::Zero(n, n);
  for (int draw = 0; draw < draws; ++draw) {
    Random random(1, static_cast<std::uint64_t>(draw));
    VecX q(n);
    for (double& one : q) one = random.normal();
    const VecX z = (root * q).cwiseProduct(reduced.size);
    const VecX d = reduced.solve(reduced.A * z, lower, upper).cwiseQuotient(reduced.size);
    sum += d * d.transpose();
  }
  return sum / draws;
}

}  // namespace

std::array<double, 2> box_profile(const MatX& J, const VecX& r, const VecX& lower,
                                  const VecX& upper, Eigen::Index of, double half) {
  const Reduced reduced(J, r);
  return {end_of(reduced, lower, upper, of, half, -1), end_of(reduced, lower, upper, of, half, 1)};
}

// Intervals and moments if an estimate rests on a bound; nothing otherwise.
std::optional<WithinBounds> within_bounds(const FitProblem& problem, const FitResult& fit) {
  const LeastSquaresResult& best = fit.best;
  const auto n = best.p.size();
  if (fit.columns.size() == 0 || !(fit.noise.total() > 0)) return {};
  const LeastSquares q = likelihood_problem(problem, fit);
  bool resting = false;
  std::vector<Eigen::Index> in;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!fit.symmetric[k]) in.push_back(i);
    resting = resting || (best.at_bound[k] && q.period_of(i) == 0);
  }
  if (!resting) return {};
  const MatX J = best.J(Eigen::all, in);
  const std::vector<bool> none(in.size(), false);
  VecX lower(J.cols()), upper(J.cols());
  for (Eigen::Index j = 0; j < J.cols(); ++j) {
    const Eigen::Index i = in[static_cast<std::size_t>(j)];
    const bool turns = q.period_of(i) > 0;
    if (turns) {
      lower[j] = -0.5 * q.period_of(i);
      upper[j] = 0.5 * q.period_of(i);
    } else {
      lower[j] = q.lower[i] - best.p[i];
      upper[j] = q.upper[i] - best.p[i];
    }
  }
  const Reduced reduced(J, best.r);
  const VecX half = normal_95 * fit.noise.total() * interval_factors(J, none, fit.noise);
  WithinBounds out;
  out.low.assign(static_cast<std::size_t>(n), nan);
  out.high = out.low;
  out.moments = MatX::Constant(n, n, nan);
  for (Eigen::Index j = 0; j < J.cols(); ++j) {
    const Eigen::Index i = in[static_cast<std::size_t>(j)];
    out.low[static_cast<std::size_t>(i)] =
        best.p[i] + end_of(reduced, lower, upper, j, half[j], -1);
    out.high[static_cast<std::size_t>(i)] =
        best.p[i] + end_of(reduced, lower, upper, j, half[j], 1);
  }
  const MatX free = covariance(J, none, fit.noise);
  if (!free.allFinite()) return out;
  const MatX moments = moments_of(reduced, lower, upper, free);
  for (Eigen::Index a = 0; a < J.cols(); ++a)
    for (Eigen::Index b = 0; b < J.cols(); ++b)
      out.moments(in[static_cast<std::size_t>(a)], in[static_cast<std::size_t>(b)]) = moments(a, b);
  return out;
}

}  // namespace langer
