#include "identification/sensitivity/sampling.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/quantile.hpp"

namespace langer {

// The indices of the points of each zone.
std::vector<std::vector<int>> points_in(const std::vector<double>& x,
                                        const std::vector<Zone>& zones) {
  std::vector<std::vector<int>> groups;
  for (const Zone& zone : zones) {
    groups.emplace_back();
    for (std::size_t i = 0; i < x.size(); ++i)
      if (inside(x[i], zone)) groups.back().push_back(static_cast<int>(i));
  }
  return groups;
}

// The 95 % interval from the quantiles of the resamples.
Estimate Resamples::around(const MatX& value) const {
  Estimate e{value, value, value};
  std::vector<double> sorted;
  for (Eigen::Index i = 0; i < value.rows(); ++i)
    for (Eigen::Index j = 0; j < value.cols(); ++j) {
      sorted.clear();
      for (const MatX& one : all_)
        if (std::isfinite(one(i, j))) sorted.push_back(one(i, j));
      std::sort(sorted.begin(), sorted.end());
      e.low(i, j) = quantile(sorted, 0.025);
      e.high(i, j) = quantile(sorted, 0.975);
    }
  return e;
}

}  // namespace langer
