#include "identification/fit/periodic.hpp"

#include <algorithm>
#include <cmath>

namespace langer {

double difference(const LeastSquares& problem, Eigen::Index parameter, double a, double b) {
  const double period = problem.period_of(parameter);
  if (period > 0) return std::remainder(b - a, period);
  return b - a;
}

double into_box(double x, double period, double lower, double upper) {
  if (x < lower) x += period * std::ceil((lower - x) / period);
  if (x > upper) x -= period * std::ceil((x - upper) / period);
  return x;
}

// An angle of symmetry: over a step of the size of its interval, the even part of the change of the
// residuals is larger than the odd part. Its column is then the second derivative.
SymmetricAngles symmetric_angles(const LeastSquares& q, const LeastSquaresResult& best,
                                 double deviation, const std::vector<double>& turn) {
  SymmetricAngles s{std::vector<bool>(static_cast<std::size_t>(best.p.size()), false), best.J};
  VecX p = best.p;
  VecX above;
  VecX below;
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    const double period = turn[static_cast<std::size_t>(i)];
    if (!(period > 0) || best.at_bound[static_cast<std::size_t>(i)]) continue;
    const double slope = best.J.col(i).norm();
    const double widest = period / 9;
    double h = widest;
    if (slope > 0) h = std::clamp(1.96 * deviation / slope, 1e-5 * period, widest);
    p[i] = best.p[i] + h;
    const bool up = q.residual(p, above) && above.allFinite();
    p[i] = best.p[i] - h;
    const bool down = q.residual(p, below) && below.allFinite();
    p[i] = best.p[i];
    if (!up || !down) continue;
    const VecX even = above + below - 2 * best.r;
    if (!((above - below).norm() < even.norm())) continue;
    s.at[static_cast<std::size_t>(i)] = true;
    s.columns.col(i) = even / (h * h);
  }
  return s;
}

}  // namespace langer
