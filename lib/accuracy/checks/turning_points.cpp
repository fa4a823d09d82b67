#include "accuracy/checks/turning_points.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace langer {

bool kink_between(const std::vector<double>& kinks, double from, double to) {
  return std::any_of(kinks.begin(), kinks.end(), [&](double t) { return from < t && t < to; });
}

std::string TurningPoint::words() const {
  const char* extremum = greatest ? "greatest" : "least";
  return fmt::format("{} has a {} value of {:.6g}{} at t = {:.5g}: a limit point", name, extremum,
                     value, unit, t);
}

// An extremum lies between the first and the last of three steps if the one between them is the
// greatest or the least: that of the parabola through them. Where a given history has a kink, the
// extremum is that of the history and no limit point.
void TurningPoints::take(const StepRecord& record, const std::vector<double>& kinks) {
  for (const auto& [name, value] : record.scalars) {
    if (name != "load_factor" && !name.starts_with("load_pressure")) continue;
    std::vector<Sample>& known = last_two_[name];
    if (known.empty()) known.push_back({0, 0});
    if (known.size() == 2) {
      const Sample a = known[0];
      const Sample b = known[1];
      const double left = (b.value - a.value) / (b.t - a.t);
      const double right = (value - b.value) / (record.t - b.t);
      if (left * right < 0 && !kink_between(kinks, a.t, record.t)) {
        const double curvature = (right - left) / (record.t - a.t);
        const double slope = left + curvature * (b.t - a.t);
        const double t = b.t - 0.5 * slope / curvature;
        const double there = b.value + slope * (t - b.t) + curvature * (t - b.t) * (t - b.t);
        const char* unit = name == "load_factor" ? "" : " MPa";
        found_.push_back({name, unit, t, there, left > 0});
      }
      known.erase(known.begin());
    }
    known.push_back({record.t, value});
  }
}

}  // namespace langer
