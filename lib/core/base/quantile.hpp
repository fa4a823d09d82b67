// The value below which a part (0 to 1) of sorted values lies, linear between neighbours; NaN where
// there are none.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

namespace langer {

inline double quantile(const std::vector<double>& sorted, double part) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double place = part * static_cast<double>(sorted.size() - 1);
  const auto i = static_cast<std::size_t>(place);
  return sorted[i] + (place - static_cast<double>(i)) *
                         (sorted[std::min(i + 1, sorted.size() - 1)] - sorted[i]);
}

}  // namespace langer
