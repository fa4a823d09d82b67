// What looks wrong in measured tests though every number can be read: units, offsets, cycles.
// Judged for soft tissues and rubbers; nothing of it is certain, so each is a warning with what to
// look at.
#pragma once

#include <string>
#include <vector>

#include "identification/fit/test_data.hpp"

namespace langer {

std::vector<std::string> doubts(
    const std::vector<Test>& tests);  // notes of their reading first; a sentence each

}  // namespace langer
