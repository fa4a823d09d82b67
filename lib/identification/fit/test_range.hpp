// What of a measured test is kept, and what counts as rest in it.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "identification/fit/test_data.hpp"

namespace langer {

// The state at which the stress along x first reaches the toe [MPa] is the new one at rest; points
// before it are left out. Throws Failure(input) where no stress is as large; file: for the message.
void shift_to_toe(Test& test, double toe, const std::string& file);

// The first points are at rest, until the deformation along x has left the first one's by a
// thousandth of what it covers. Stretches are divided by their mean (amounts of shear lose theirs),
// stresses lose theirs, which is an offset of the device.
void shift_to_start(Test& test);

// points whose engineering strain (of `along`; in simple shear the amount) lies in from..to
void keep_range(Test& test, const std::vector<double>& along, double from, double to);

// points of from..to [s]; nothing happens to a test without times
void keep_times(Test& test, double from, double to);

// the points of these indices
void keep_points(Test& test, const std::function<bool(std::size_t)>& kept);

// points before this time [s] become its history
void compare_from(Test& test, double from);

// the first n points become its history
void make_history(Test& test, std::size_t n);

// When a viscous specimen was deformed to the state of the first reading. Times spaced by logarithm
// hold no 0, so that the first reading of a relaxation test is not its beginning.
struct StepStart {
  std::optional<double> step_at;  // [s], where the deformation leaves rest
  std::optional<double> ramp;     // [s], how long it took; the deformation grows linearly
  bool is_given() const { return step_at || ramp; }
};

// Puts rest and the ramp in front of the history. Without `step_at` the ramp ends at the first
// reading. Throws Failure(input) where the ramp ends after it.
void add_step(Test& test, const StepStart& step, const std::string& file);

// Whether a test with times begins with a deformed and stressed specimen at a time other than 0:
// then the file does not say when the specimen was deformed.
bool starts_loaded(const Test& test);

// stresses over the largest of the test; throws Failure(input) where all are 0
void normalise(Test& test, const std::string& file);

}  // namespace langer
