#include "identification/fit/test_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/base/error.hpp"
#include "core/base/text.hpp"

namespace langer {

namespace {

// All lists of a test that have a value for each point. Some may be empty.
std::array<std::vector<double>*, 5> lists(Test& test) {
  return {&test.first, &test.second, &test.stress_x, &test.stress_z, &test.time};
}

// Takes the body at the stretch l0 as the undeformed one. Areas at rest become smaller by 1/l0, so
// that nominal stresses grow by l0, and second Piola-Kirchhoff stresses by l0^2.
void refer_to(double l0, StressMeasure measure, std::vector<double>& stretches,
              std::vector<double>& stresses) {
  double area = 1;
  if (measure == StressMeasure::nominal) area = l0;
  if (measure == StressMeasure::second_piola) area = l0 * l0;
  for (double& l : stretches) l /= l0;
  for (double& s : stresses) s *= area;
}

// The value of Test::first in the undeformed state.
double at_rest(const Test& test) {
  if (test.kind == TestKind::simple_shear) return 0;
  return 1;
}

}  // namespace

void keep_points(Test& test, const std::function<bool(std::size_t)>& kept) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < test.points(); ++i) {
    if (!kept(i)) continue;
    for (auto* list : lists(test)) {
      if (!list->empty()) (*list)[n] = (*list)[i];
    }
    ++n;
  }
  for (auto* list : lists(test)) {
    if (!list->empty()) list->resize(n);
  }
}

void shift_to_toe(Test& test, double toe, const std::string& file) {
  const auto error = [&](std::string found, std::string expected) {
    return Failure(Exit::input, {{file, 0, 0}, "toe", std::move(found), std::move(expected), ""});
  };
  std::size_t k = 0;
  while (k < test.points() && test.stress_x[k] < toe) ++k;
  if (k == test.points())
    throw error(fmt::format("found {:g} MPa, and no stress of {} as large", toe,
                            text_or(test.name, "the test")),
                "less");
  // Interpolates a stretch linearly to the stress `toe`.
  const auto at_toe = [&](const std::vector<double>& l) {
    if (k == 0) return l[0];
    const double s = (toe - test.stress_x[k - 1]) / (test.stress_x[k] - test.stress_x[k - 1]);
    return l[k - 1] + s * (l[k] - l[k - 1]);
  };
  const double x0 = at_toe(test.first);
  double z0 = x0;
  if (!test.second.empty()) z0 = at_toe(test.second);
  refer_to(x0, test.measure, test.first, test.stress_x);
  // Pure shear holds z. An equibiaxial test stretches z like x.
  if (test.kind == TestKind::pure_shear) z0 = 1;
  refer_to(z0, test.measure, test.second, test.stress_z);
  for (auto* list : lists(test))
    if (!list->empty()) list->erase(list->begin(), list->begin() + static_cast<std::ptrdiff_t>(k));
}

void shift_to_start(Test& test) {
  const auto [least, most] = std::minmax_element(test.first.begin(), test.first.end());
  const double moved = 1e-3 * (*most - *least);
  std::size_t n = 1;
  while (n < test.points() && std::abs(test.first[n] - test.first[0]) <= moved) ++n;
  const auto mean = [n](const std::vector<double>& all) {
    return std::accumulate(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n), 0.0) /
           static_cast<double>(n);
  };
  for (auto* stresses : {&test.stress_x, &test.stress_z})
    if (!stresses->empty())
      for (const double at_rest = mean(*stresses); double& s : *stresses) s -= at_rest;
  const double x0 = mean(test.first);
  double z0 = x0;
  if (!test.second.empty()) z0 = mean(test.second);
  if (test.kind == TestKind::simple_shear) {
    for (double& g : test.first) g -= x0;
    return;
  }
  refer_to(x0, test.measure, test.first, test.stress_x);
  if (test.kind == TestKind::pure_shear) z0 = 1;
  refer_to(z0, test.measure, test.second, test.stress_z);
}

void keep_range(Test& test, const std::vector<double>& along, double from, double to) {
  keep_points(test, [&](std::size_t i) {
    double strain = 0;
    if (test.kind == TestKind::simple_shear) {
      strain = along[i];
    } else {
      strain = engineering_strain(along[i]);
    }
    return strain >= from && strain <= to;
  });
}

void keep_times(Test& test, double from, double to) {
  if (!test.time.empty())
    keep_points(
        test, [&, times = test.time](std::size_t i) { return times[i] >= from && times[i] <= to; });
}

void compare_from(Test& test, double from) {
  std::size_t n = 0;
  while (n < test.time.size() && test.time[n] < from) ++n;
  make_history(test, n);
}

void make_history(Test& test, std::size_t n) {
  const auto first_ones = [n](const std::vector<double>& all) {
    const std::size_t end = std::min(n, all.size());
    return std::vector<double>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(end));
  };
  test.before = {first_ones(test.first), first_ones(test.second), first_ones(test.time)};
  if (n > 0) {
    keep_points(test, [n](std::size_t i) { return i >= n; });
  }
}

void add_step(Test& test, const StepStart& step, const std::string& file) {
  const bool has_history = !test.before.time.empty();
  // The first reading is in the history if there is one.
  const std::vector<double>& times = has_history ? test.before.time : test.time;
  const std::vector<double>& first = has_history ? test.before.first : test.first;
  const std::vector<double>& second = has_history ? test.before.second : test.second;
  if (times.empty()) {
    return;
  }
  const double first_reading = times.front();
  const double ramp = step.ramp.value_or(0);
  const double start = step.step_at.value_or(first_reading - ramp);
  const double rounding = 1e-12 * (std::abs(start) + ramp + std::abs(first_reading));
  if (start + ramp > first_reading + rounding) {
    throw Failure(Exit::input,
                  {{file, 0, 0},
                   step.step_at ? "step_at" : "ramp",
                   fmt::format("found a step that ends at {:g} s, and a first reading at {:g} s",
                               start + ramp, first_reading),
                   "a step that ends before the first reading",
                   "a shorter ramp, or an earlier step_at"});
  }

  // A ramp is followed in 20 increments; a step of no duration is one.
  int increments = 1;
  if (ramp > 0) increments = 20;
  // The ramp goes linearly from rest to the state of the first reading.
  Past past;
  for (int i = 0; i <= increments; ++i) {
    const double part = static_cast<double>(i) / increments;
    past.time.push_back(std::min(start + part * ramp, first_reading));
    past.first.push_back(at_rest(test) + part * (first.front() - at_rest(test)));
    if (!second.empty()) past.second.push_back(1 + part * (second.front() - 1));
  }
  const auto append = [](std::vector<double>& all, const std::vector<double>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  append(past.time, test.before.time);
  append(past.first, test.before.first);
  append(past.second, test.before.second);
  test.before = std::move(past);
}

bool starts_loaded(const Test& test) {
  const bool has_history = !test.before.time.empty();
  if (test.time.empty()) {
    return false;
  }
  double first_time = test.time.front();
  double first = test.first.front();
  if (has_history) {
    first_time = test.before.time.front();
    first = test.before.first.front();
  }
  double reach = 0;
  for (const double x : test.first) reach = std::max(reach, std::abs(x - at_rest(test)));
  const double part = std::abs(first - at_rest(test)) / std::max(reach, 1e-300);
  double stress = 1;  // the stresses of a history are not known
  if (!has_history) {
    stress = std::abs(test.stress_x.front()) / std::max(largest_stress(test), 1e-300);
  }
  constexpr double loaded = 0.05;
  return first_time != 0 && part > loaded && stress > loaded;
}

void normalise(Test& test, const std::string& file) {
  const double largest = largest_stress(test);
  if (!(largest > 0))
    throw Failure(
        Exit::input,
        {{file, 0, 0}, "normalised", "found no stress but 0", "one above it at least", ""});
  for (auto* stresses : {&test.stress_x, &test.stress_z})
    for (double& s : *stresses) s /= largest;
}

}  // namespace langer
