// What of a measured test is kept, and what counts as rest in it.
#pragma once

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

// points before this time [s] become its history
void compare_from(Test& test, double from);

// stresses over the largest of the test; throws Failure(input) where all are 0
void normalise(Test& test, const std::string& file);

}  // namespace langer
