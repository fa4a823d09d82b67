#include "identification/fit/test_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/base/error.hpp"

namespace langer {

namespace {

std::array<std::vector<double>*, 5> lists(Test& test) {
  return {&test.first, &test.second, &test.stress_x, &test.stress_z, &test.time};
}

void keep_where(Test& test, const std::function<bool(std::size_t)>& kept) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < test.points(); ++i) {
    if (!kept(i)) continue;
    for (auto* list : lists(test))
      if (!list->empty()) (*list)[n] = (*list)[i];
    ++n;
  }
  for (auto* list : lists(test))
    if (!list->empty()) list->resize(n);
}

// The body at the stretch l0 is the new one at rest: P l is the force over its area, S l^2 too.
void refer_to(double l0, StressMeasure measure, std::vector<double>& stretches,
              std::vector<double>& stresses) {
  const double area = measure == StressMeasure::nominal        ? l0
                      : measure == StressMeasure::second_piola ? l0 * l0
                                                               : 1;
  for (double& l : stretches) l /= l0;
  for (double& s : stresses) s *= area;
}

}  // namespace

void shift_to_toe(Test& test, double toe, const std::string& file) {
  const auto error = [&](std::string found, std::string expected) {
    return Failure(Exit::input, {{file, 0, 0}, "toe", std::move(found), std::move(expected), ""});
  };
  std::size_t k = 0;
  while (k < test.points() && test.stress_x[k] < toe) ++k;
  if (k == test.points())
    throw error(fmt::format("found {:g} MPa, and no stress of {} as large", toe,
                            test.name.empty() ? "the test" : test.name),
                "less");
  const auto at_toe = [&](const std::vector<double>& l) {
    if (k == 0) return l[0];
    const double s = (toe - test.stress_x[k - 1]) / (test.stress_x[k] - test.stress_x[k - 1]);
    return l[k - 1] + s * (l[k] - l[k - 1]);
  };
  const double x0 = at_toe(test.first), z0 = test.second.empty() ? x0 : at_toe(test.second);
  refer_to(x0, test.measure, test.first, test.stress_x);
  // pure shear holds z, an equibiaxial test pulls it alike
  refer_to(test.kind == TestKind::pure_shear ? 1 : z0, test.measure, test.second, test.stress_z);
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
  const double x0 = mean(test.first), z0 = test.second.empty() ? x0 : mean(test.second);
  if (test.kind == TestKind::simple_shear) {
    for (double& g : test.first) g -= x0;
    return;
  }
  refer_to(x0, test.measure, test.first, test.stress_x);
  refer_to(test.kind == TestKind::pure_shear ? 1 : z0, test.measure, test.second, test.stress_z);
}

void keep_range(Test& test, const std::vector<double>& along, double from, double to) {
  keep_where(test, [&](std::size_t i) {
    const double strain =
        test.kind == TestKind::simple_shear ? along[i] : engineering_strain(along[i]);
    return strain >= from && strain <= to;
  });
}

void keep_times(Test& test, double from, double to) {
  if (!test.time.empty())
    keep_where(
        test, [&, times = test.time](std::size_t i) { return times[i] >= from && times[i] <= to; });
}

void compare_from(Test& test, double from) {
  std::size_t n = 0;
  while (n < test.time.size() && test.time[n] < from) ++n;
  const auto up_to_n = [&](const std::vector<double>& all) {
    return std::vector<double>(all.begin(),
                               all.begin() + static_cast<std::ptrdiff_t>(std::min(n, all.size())));
  };
  test.before = {up_to_n(test.first), up_to_n(test.second), up_to_n(test.time)};
  if (n > 0) keep_where(test, [n](std::size_t i) { return i >= n; });
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
