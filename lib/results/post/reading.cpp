#include "results/post/reading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace langer {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

// The interval in which a column first reaches a number: from k - 1 to k; 0 if it never does.
std::size_t first_reached(const std::vector<double>& over, double at) {
  for (std::size_t k = 1; k < over.size(); ++k) {
    const double before = over[k - 1] - at;
    const double after = over[k] - at;
    if (before == 0 && after == 0) continue;
    if (before * after <= 0) return k;
  }
  return 0;
}

// The row of a time; none where no state lies there.
std::optional<std::size_t> row_at(const std::vector<double>& seconds, double wanted) {
  const double tolerance = 1e-6 * std::max(1e-3, seconds.back());
  for (std::size_t k = 0; k < seconds.size(); ++k) {
    if (std::abs(seconds[k] - wanted) <= tolerance) return k;
  }
  return std::nullopt;
}

// The area under a column over another one, between two rows.
double area_under(const std::vector<double>& over, const std::vector<double>& of, std::size_t from,
                  std::size_t to) {
  // Trapezoids: the columns are straight lines between states, as in value_where.
  double area = 0;
  for (std::size_t k = from + 1; k <= to; ++k) {
    area += 0.5 * (of[k] + of[k - 1]) * (over[k] - over[k - 1]);
  }
  return area;
}

}  // namespace

std::vector<Complaint> ReadingChoice::complaints() const {
  const int ways = value_of.has_value() + slope_of.has_value() + hysteresis_of.has_value() +
                   suction_of.has_value();
  const char* const four = "one of value_of, slope_of, hysteresis_of and suction_of";
  if (ways != 1) return {{"", ways == 0 ? "none of the four" : "more than one", four, ""}};
  std::vector<Complaint> found;
  if (suction_of) {
    if (over) found.push_back({"over", *over, "no such key: suction_of goes by seconds", ""});
    if (at) found.push_back({"at", "a number", "no such key: suction_of has times", ""});
    if (!suction) found.push_back({"suction", "missing", "how long the suction lasts, in s", ""});
    if (!release) found.push_back({"release", "missing", "how long the skin is left, in s", ""});
    const double shorter = std::min(suction.value_or(immediate), release.value_or(immediate));
    if (immediate > shorter)
      found.push_back({"immediate", "longer than suction or release", "a part of both", ""});
    return found;
  }
  if (!over) found.push_back({"over", "missing", "the name of the other column", ""});
  if (suction) found.push_back({"suction", "a time", "no such key without suction_of", ""});
  if (release) found.push_back({"release", "a time", "no such key without suction_of", ""});
  if (hysteresis_of && at)
    found.push_back({"at", "a number", "no such key: hysteresis_of takes the whole cycle", ""});
  if (!hysteresis_of && !at)
    found.push_back({"at", "missing", "the number that `over` reaches there", ""});
  return found;
}

double value_where(const std::vector<double>& over, const std::vector<double>& of, double at) {
  const std::size_t k = first_reached(over, at);
  if (k == 0) return none;
  const double part = (at - over[k - 1]) / (over[k] - over[k - 1]);
  return of[k - 1] + part * (of[k] - of[k - 1]);
}

// The third state is the neighbour that lies nearer to the place, on the same branch.
double slope_where(const std::vector<double>& over, const std::vector<double>& of, double at) {
  const std::size_t k = first_reached(over, at);
  if (k == 0) return none;
  const auto secant = [&](std::size_t i, std::size_t j) {
    return (of[j] - of[i]) / (over[j] - over[i]);
  };
  const double sense = over[k] - over[k - 1];
  const bool has_before = k >= 2 && (over[k - 1] - over[k - 2]) * sense > 0;
  const bool has_after = k + 1 < over.size() && (over[k + 1] - over[k]) * sense > 0;
  if (!has_before && !has_after) return secant(k - 1, k);
  bool take_after = has_after;
  if (has_before && has_after) take_after = std::abs(over[k + 1] - at) < std::abs(over[k - 2] - at);
  const std::size_t third = take_after ? k + 1 : k - 2;
  // Newton's form: f[0,1] + f[0,1,2] (2 x - x0 - x1)
  const double first = secant(k - 1, k);
  const double second = (secant(k, third) - first) / (over[third] - over[k - 1]);
  return first + second * (2 * at - over[k - 1] - over[k]);
}

Loop last_loop(const std::vector<double>& over, const std::vector<double>& of) {
  Loop loop;
  if (over.size() < 3) return {none, none};
  // The top is the last state that both neighbours do not exceed; from there it goes back.
  std::size_t top = 0;
  for (std::size_t k = 1; k + 1 < over.size(); ++k) {
    if (over[k] >= over[k - 1] && over[k] > over[k + 1]) top = k;
  }
  if (top == 0) return {none, none};
  std::size_t begin = top;
  while (begin > 0 && over[begin - 1] <= over[begin]) --begin;
  std::size_t end = top;
  while (end + 1 < over.size() && over[end + 1] <= over[end]) ++end;
  // A path that does not come back as far as it began is closed where it ends.
  loop.loading = area_under(over, of, begin, top);
  loop.unloading = -area_under(over, of, top, end);
  return loop;
}

SuctionCycles suction_cycles(const std::vector<double>& seconds, const std::vector<double>& height,
                             const ReadingChoice& choice, std::optional<MissingTime>& missing) {
  SuctionCycles found;
  const double period = *choice.suction + *choice.release;
  const double lasts = seconds.back() - choice.begins;
  found.cycles = static_cast<int>(std::floor(lasts / period + 1e-6));
  const auto height_at = [&](double time) {
    const auto row = row_at(seconds, time);
    if (row) return height[*row];
    if (!missing) missing = MissingTime{time};
    return none;
  };
  const double zero = height_at(choice.begins);
  const double end_of_suction = choice.begins + *choice.suction;
  found.ue = height_at(choice.begins + choice.immediate) - zero;
  found.uf = height_at(end_of_suction) - zero;
  found.ur = found.uf - (height_at(end_of_suction + choice.immediate) - zero);
  found.ua = found.uf - (height_at(choice.begins + period) - zero);
  // R3 and R4 are those of the last complete cycle, and count from the same zero as the first.
  const double last = choice.begins + (found.cycles - 1) * period;
  found.last_maximum = height_at(last + *choice.suction) - zero;
  found.last_minimum = height_at(last + period) - zero;
  return found;
}

}  // namespace langer
