#include "accuracy/estimate/observed_law.hpp"

#include <algorithm>
#include <cmath>

namespace langer {

std::optional<ObservedLaw> observed_law(const std::vector<double>& length,
                                        const std::vector<double>& values, double theory) {
  constexpr double least = 0.35;  // a smaller order is none
  if (length.size() != 3 || values.size() != 3) return std::nullopt;
  const double near = values[1] - values[0];
  const double far = values[2] - values[1];
  const double rounding = 1e-9 * std::abs(values[0]);
  if (std::abs(near) <= rounding) return ObservedLaw{values[0], theory, 0.5 * std::abs(far), false};
  const auto ratio = [&](double p) {
    return (std::pow(length[1], p) - std::pow(length[0], p)) /
           (std::pow(length[2], p) - std::pow(length[1], p));
  };
  const auto limit = [&](double p) {
    return values[0] - near / (std::pow(length[1] / length[0], p) - 1);
  };
  if (near * far <= 0) {
    const double larger = std::max(std::abs(near), std::abs(far));
    return ObservedLaw{values[0], theory, larger, false};
  }
  const double found = near / far;
  if (found >= ratio(least)) return ObservedLaw{limit(least), least, 0, true};
  double low = least;
  double high = 8;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    if (ratio(middle) > found) {
      low = middle;
    } else {
      high = middle;
    }
  }
  if (low <= theory) return ObservedLaw{limit(low), low, 0, false};
  // Falling faster than theory says, by superconvergence or as two errors happen to cancel: the
  // larger difference then says more.
  const double by_far =
      values[0] - (values[2] - values[0]) / (std::pow(length[2] / length[0], theory) - 1);
  const double by_near = limit(theory);
  const bool far_is_further = std::abs(by_far - values[0]) > std::abs(by_near - values[0]);
  return ObservedLaw{far_is_further ? by_far : by_near, theory, 0, false};
}

}  // namespace langer
