#include "identification/population/mean_curves.hpp"

#include <algorithm>

namespace langer {

namespace {

bool grows(const std::vector<double>& x) {
  for (std::size_t i = 1; i < x.size(); ++i)
    if (!(x[i] > x[i - 1])) return false;
  return x.size() > 1;
}

// the deformation that the curve is a function of: that along x, or the one along z
const std::vector<double>* abscissa(const Test& test) {
  if (grows(test.first)) return &test.first;
  if (grows(test.second)) return &test.second;
  return nullptr;
}

double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto above = std::lower_bound(x.begin(), x.end(), at);
  if (above == x.begin()) return y.front();
  if (above == x.end()) return y.back();
  const auto i = static_cast<std::size_t>(above - x.begin());
  const double share = (at - x[i - 1]) / (x[i] - x[i - 1]);
  return y[i - 1] + share * (y[i] - y[i - 1]);
}

// Averages onto the points of the first of them; false where they have no range in common.
bool average(const std::vector<const Test*>& tests, Test& mean) {
  mean = *tests.front();
  const bool along_x = abscissa(mean) == &tests.front()->first || grows(mean.first);
  const auto place = [&](const Test& test) -> const std::vector<double>& {
    return along_x ? test.first : test.second;
  };
  double from = -1e300;
  double to = 1e300;
  for (const Test* test : tests) {
    if (!grows(place(*test)) || !test->time.empty()) return false;
    if (test->stress_z.empty() != mean.stress_z.empty()) return false;
    from = std::max(from, place(*test).front());
    to = std::min(to, place(*test).back());
  }
  const std::vector<double> grid = place(mean);
  Test result = mean;
  result.first.clear();
  result.second.clear();
  result.stress_x.clear();
  result.stress_z.clear();
  const auto n = static_cast<double>(tests.size());
  const double rounding = 1e-9;
  for (const double x : grid) {
    if (x < from - rounding || x > to + rounding) continue;
    double first = 0, second = 0, stress_x = 0, stress_z = 0;
    for (const Test* test : tests) {
      first += interpolated(place(*test), test->first, x) / n;
      if (!test->second.empty()) second += interpolated(place(*test), test->second, x) / n;
      stress_x += interpolated(place(*test), test->stress_x, x) / n;
      if (!test->stress_z.empty()) stress_z += interpolated(place(*test), test->stress_z, x) / n;
    }
    result.first.push_back(first);
    if (!mean.second.empty()) result.second.push_back(second);
    result.stress_x.push_back(stress_x);
    if (!mean.stress_z.empty()) result.stress_z.push_back(stress_z);
  }
  mean = result;
  return mean.points() >= 2;
}

}  // namespace

std::vector<Test> mean_curves(const std::vector<std::vector<Test>>& of_specimens) {
  std::vector<std::string> names;
  for (const std::vector<Test>& tests : of_specimens)
    for (const Test& test : tests)
      if (std::find(names.begin(), names.end(), test.name) == names.end())
        names.push_back(test.name);
  std::vector<Test> means;
  for (const std::string& name : names) {
    std::vector<const Test*> same;
    for (const std::vector<Test>& tests : of_specimens)
      for (const Test& test : tests)
        if (test.name == name) same.push_back(&test);
    // a test that only a few specimens have is no mean of all
    if (2 * same.size() < of_specimens.size()) continue;
    Test mean;
    if (average(same, mean)) means.push_back(std::move(mean));
  }
  return means;
}

}  // namespace langer
