// Branches and cycles of a measured test.
//
// A record of cycles consists of branches between the points where the deformation turns round.
// Loading branches lead away from rest (in compression the deformation falls there), unloading
// branches lead back. A cycle is a loading branch and the unloading branch behind it; turns by less
// than 3 % of the range of the deformation are noise.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "identification/fit/test_data.hpp"

namespace langer {

// First and last point included.
std::vector<std::size_t> turning_points(const std::vector<double>& deformation);

// Keeps what `choice` names. In a test with times the points before the chosen cycle stay as its
// history, see make_history(). Throws Failure(input) where the file has no such cycle.
void keep_cycles(Test& test, const TestCycles& choice, const std::string& file);

}  // namespace langer
