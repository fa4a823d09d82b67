// Values along the load path, t from 0 to 1: given at points, linear between them and from 0 at t =
// 0 to the first point, constant after the last. A single number instead of a list grows in
// proportion to t.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"

namespace langer {

template <class Value>
struct HistoryPoint {
  double t = 0;
  Value to{};
  friend bool operator==(const HistoryPoint&, const HistoryPoint&) = default;
};

// points: at least one, t > 0 and ascending
template <class Value>
Value value_at(const std::vector<HistoryPoint<Value>>& points, double t) {
  HistoryPoint<Value> before{0, 0.0 * points.front().to};
  for (const HistoryPoint<Value>& point : points) {
    if (t <= point.t)
      return before.to + (t - before.t) / (point.t - before.t) * (point.to - before.to);
    before = point;
  }
  return before.to;
}

// Of values between -1 and 1; none: t itself.
using LoadFactor = std::shared_ptr<const std::vector<HistoryPoint<double>>>;

inline double factor_at(const LoadFactor& factor, double t) {
  if (factor) return value_at(*factor, t);
  return t;
}
// The derivative of the factor; at a kink that of the interval before it.
double factor_rate(const LoadFactor& factor, double t);
inline bool same_factor(const LoadFactor& a, const LoadFactor& b) {
  return a == b || (a && b && *a == *b);
}

// A load: its largest value, with a sign, times a factor. Mirror images of a load share its factor.
struct History {
  double value = 0;
  LoadFactor factor;
  double at(double t) const { return value * factor_at(factor, t); }
  double rate(double t) const { return value * factor_rate(factor, t); }
  // whether the mean rate from `now` to `next` is that from `before` to `now`
  bool keeps_rate(double before, double now, double next) const;
  friend bool operator==(const History& a, const History& b) {
    return a.value == b.value && same_factor(a.factor, b.factor);
  }
};

// A history in a config: a number, or a list of points. The unit is that of the key.
struct HistoryPointConfig {
  std::optional<double> t;
  double to = 0;
  std::optional<double> s;
  static void fields(auto& v);
};
struct HistoryConfig {
  double value = 0;  // where there are no points
  std::vector<HistoryPointConfig> points;
  bool moves() const;  // other than 0 somewhere
  double at_end() const {
    if (points.empty()) return value;
    return points.back().to;
  }
};
// The place of a point on the path: t, or s over the seconds of the path. All kinds of histories
// use this listing and this rule.
template <class Point>
double place(const Point& point, std::optional<double> seconds) {
  if (point.s) return *point.s / seconds.value();
  return point.t.value();
}
template <class Point>
void list_place(auto& v) {
  v(&Point::t, "t", unit::none, "place on the path, 0 to 1", Range{0, 1, false, true});
  v(&Point::s, "s", unit::s,
    "instead of t, if path.seconds gives the duration of the path: time since its beginning",
    Range{0, std::numeric_limits<double>::infinity(), false, true});
}
// seconds: of the path, where it has a duration
History history_of(const HistoryConfig& config, std::optional<double> seconds);

// example: "{t: 1, to: [x, y, z]}"
template <class Point>
std::vector<Complaint> place_complaints(const std::vector<Point>& points, const char* key,
                                        const char* example) {
  std::vector<Complaint> found;
  if (points.empty())
    found.push_back({key, "found an empty list", std::string("at least ") + example, ""});
  bool in_t = false;
  bool in_s = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& p = points[i];
    if (p.t.has_value() == p.s.has_value())
      found.push_back({std::string(key) + "[" + std::to_string(i) + "]",
                       p.t ? "found t and s" : "found neither t nor s", "one of the two",
                       "t: 0 to 1 along the path; s: seconds, with path: {seconds: ...}"});
    in_t = in_t || p.t;
    in_s = in_s || p.s;
    if (i > 0 && (p.t <= points[i - 1].t && p.s <= points[i - 1].s))
      found.push_back({key, "times that do not increase",
                       std::string("each ") + (in_s ? "s" : "t") + " greater than the one before",
                       ""});
  }
  if (in_t && in_s && found.empty())
    found.push_back({key, "t and s in one list", "one of the two", ""});
  return found;
}

void HistoryPointConfig::fields(auto& v) {
  list_place<HistoryPointConfig>(v);
  v(&HistoryPointConfig::to, "to", unit::none, "value there, in the unit of the key", required);
}

}  // namespace langer
