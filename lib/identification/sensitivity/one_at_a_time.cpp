#include "identification/sensitivity/one_at_a_time.hpp"

#include <cmath>
#include <limits>

namespace langer {

OneAtATime one_at_a_time(const ParametricCurve& phi, const VecX& value, const VecX& lower,
                         const VecX& upper, int n) {
  OneAtATime result;
  for (Eigen::Index j = 0; j < value.size(); ++j) {
    VecX p = value;
    VecX before;
    VecX after;
    const double step = (upper[j] - lower[j]) / n;
    MatX d;  // (points, n)
    for (int i = 0; i <= n; ++i) {
      if (i < n) {
        p[j] = lower[j] + i * step;
      } else {
        p[j] = upper[j];
      }
      if (!phi(p, after) || !after.allFinite()) {
        result.missing = p;
        return result;
      }
      if (i == 0) d.resize(after.size(), n);
      if (i > 0) d.col(i - 1) = (after - before) / step;
      before = after;
    }
    // The number of points of the curve is known after the first parameter.
    if (j == 0) {
      result.mu_star.resize(value.size(), d.rows());
      result.s = result.spread = result.mu_star;
    }
    const VecX mu_star = d.cwiseAbs().rowwise().mean();
    const VecX mean = d.rowwise().mean();
    result.mu_star.row(j) = mu_star;
    result.s.row(j) = ((d.colwise() - mu_star).rowwise().squaredNorm() / (n - 1)).cwiseSqrt();
    result.spread.row(j) = ((d.colwise() - mean).rowwise().squaredNorm() / (n - 1)).cwiseSqrt();
  }
  result.complete = true;
  return result;
}

// Whether a point is in a zone. Both ends belong to it.
bool inside(double x, const Zone& zone) {
  const double rounding = 1e-9 * (zone.to - zone.from);  // 0.2 may be 0.19999999999999998
  return x >= zone.from - rounding && x <= zone.to + rounding;
}

MatX zone_means(const MatX& of, const std::vector<double>& x, const std::vector<Zone>& zones) {
  MatX means(of.rows(), static_cast<Eigen::Index>(zones.size()));
  for (std::size_t z = 0; z < zones.size(); ++z) {
    VecX sum = VecX::Zero(of.rows());
    int points = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      if (inside(x[i], zones[z])) {
        sum += of.col(static_cast<Eigen::Index>(i));
        ++points;
      }
    if (points) {
      means.col(static_cast<Eigen::Index>(z)) = VecX(sum / points);
    } else {
      means.col(static_cast<Eigen::Index>(z)) =
          VecX::Constant(of.rows(), std::numeric_limits<double>::quiet_NaN());
    }
  }
  return means;
}

}  // namespace langer
