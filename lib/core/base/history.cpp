#include "core/base/history.hpp"

#include <algorithm>
#include <cmath>

namespace langer {

double factor_rate(const LoadFactor& factor, double t) {
  if (!factor) return 1;
  HistoryPoint<double> before;
  for (const HistoryPoint<double>& point : *factor) {
    if (t <= point.t) return (point.to - before.to) / (point.t - before.t);
    before = point;
  }
  return 0;
}

bool History::keeps_rate(double before, double now, double next) const {
  if (!factor) return true;
  const double rate = (at(next) - at(now)) / (next - now);
  const double last = (at(now) - at(before)) / (now - before);
  return std::abs(rate - last) <= 1e-6 * std::max(std::abs(rate), std::abs(last));
}

bool HistoryConfig::moves() const {
  if (points.empty()) return value != 0;
  return std::any_of(points.begin(), points.end(), [](const auto& point) { return point.to != 0; });
}

History history_of(const HistoryConfig& config, std::optional<double> seconds) {
  if (config.points.empty()) return {config.value, nullptr};
  if (!config.moves()) return {};
  History history;
  for (const HistoryPointConfig& point : config.points)
    if (std::abs(point.to) > std::abs(history.value)) history.value = point.to;
  if (config.points.size() == 1 && place(config.points[0], seconds) == 1)
    return history;  // in proportion to t
  std::vector<HistoryPoint<double>> factor;
  for (const HistoryPointConfig& point : config.points)
    factor.push_back({place(point, seconds), point.to / history.value});
  history.factor = std::make_shared<const std::vector<HistoryPoint<double>>>(std::move(factor));
  return history;
}

}  // namespace langer
