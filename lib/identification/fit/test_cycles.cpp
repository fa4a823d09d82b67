#include "identification/fit/test_cycles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "core/base/text.hpp"
#include "identification/fit/test_range.hpp"

namespace langer {

namespace {

struct BranchRange {
  std::size_t begin = 0, end = 0;  // both points included
  bool loading = true;
};

// Rest is a strain of 0: loading leads to the side that the test reaches farther.
std::vector<BranchRange> branches(const Test& test) {
  double rest = 1;
  if (test.kind == TestKind::simple_shear) rest = 0;
  const auto [least, most] = std::minmax_element(test.first.begin(), test.first.end());
  const bool upwards = std::abs(*most - rest) >= std::abs(*least - rest);

  const std::vector<std::size_t> turns = turning_points(test.first);
  std::vector<BranchRange> all;
  for (std::size_t i = 0; i + 1 < turns.size(); ++i) {
    const bool rises = test.first[turns[i + 1]] > test.first[turns[i]];
    all.push_back({turns[i], turns[i + 1], rises == upwards});
  }
  return all;
}

// The point of the largest absolute stress along x.
std::size_t point_of_peak(const Test& test) {
  const auto smaller = [](double a, double b) {
    return std::abs(a) < std::abs(b);
  };
  const auto peak = std::max_element(test.stress_x.begin(), test.stress_x.end(), smaller);
  return static_cast<std::size_t>(peak - test.stress_x.begin());
}

}  // namespace

// Points where the deformation reverses by more than the noise.
std::vector<std::size_t> turning_points(const std::vector<double>& deformation) {
  if (deformation.size() < 2) {
    return {};
  }
  const auto [least, most] = std::minmax_element(deformation.begin(), deformation.end());
  const double noise = 0.03 * (*most - *least);

  enum class Way { open, up, down };
  Way way = Way::open;
  std::vector<std::size_t> turns{0};
  std::size_t high = 0;  // the extreme points since the last turn
  std::size_t low = 0;
  for (std::size_t i = 0; i < deformation.size(); ++i) {
    const double x = deformation[i];
    if (x > deformation[high]) high = i;
    if (x < deformation[low]) low = i;
    const bool rose = x - deformation[low] > noise;
    const bool fell = deformation[high] - x > noise;
    if (way != Way::up && rose) {
      if (way == Way::down) turns.push_back(low);
      way = Way::up;
      high = i;
    } else if (way != Way::down && fell) {
      if (way == Way::up) turns.push_back(high);
      way = Way::down;
      low = i;
    }
  }
  if (turns.back() + 1 < deformation.size()) {
    turns.push_back(deformation.size() - 1);
  }
  return turns;
}

// Keeps the cycles and branches that the config chooses. Earlier cycles become history if the test
// has times.
void keep_cycles(Test& test, const TestCycles& choice, const std::string& file) {
  if (test.points() == 0) {
    return;
  }
  if (choice.until == KeptUntil::peak) {
    const std::size_t peak = point_of_peak(test);
    keep_points(test, [&](std::size_t i) { return i <= peak; });
  }
  const bool all_cycles = choice.cycle == KeptCycle::all && choice.skip_cycles == 0;
  if (all_cycles && choice.branch == KeptBranch::all) {
    return;
  }

  const std::vector<BranchRange> all = branches(test);
  std::vector<std::size_t> cycles;  // the point where each begins
  for (const BranchRange& branch : all) {
    if (branch.loading) cycles.push_back(branch.begin);
  }
  const auto skipped = static_cast<std::size_t>(choice.skip_cycles);
  if (cycles.size() <= skipped) {
    throw Failure(Exit::input, {{file, 0, 0},
                                skipped > 0 ? "skip_cycles" : "branch",
                                fmt::format("found {} loading branches in {}", cycles.size(),
                                            text_or(test.name, "the test")),
                                fmt::format("more than {}", skipped),
                                "turns by less than 3 % of the range of the strain are noise"});
  }
  // What lies before the first loading branch belongs to the first cycle.
  std::size_t begin = 0;
  if (choice.cycle == KeptCycle::last) {
    begin = cycles.back();
  } else if (skipped > 0) {
    begin = cycles[skipped];
  }

  if (!test.time.empty()) {
    make_history(test, begin);
    return;
  }
  std::vector<bool> kept(test.points(), choice.branch == KeptBranch::all);
  for (const BranchRange& branch : all) {
    if (branch.loading == (choice.branch == KeptBranch::loading)) {
      std::fill(kept.begin() + static_cast<std::ptrdiff_t>(branch.begin),
                kept.begin() + static_cast<std::ptrdiff_t>(branch.end) + 1, true);
    }
  }
  keep_points(test, [&](std::size_t i) { return i >= begin && kept[i]; });
}

}  // namespace langer
