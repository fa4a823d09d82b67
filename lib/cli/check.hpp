// Whether a YAML file is right, without running anything.
#pragma once

#include <string>

namespace langer {

// "solve", "pipeline", ...: from the line that names its schema, otherwise from its keys; throws
// Failure(config) where both fail
std::string kind_of(const std::string& path);

// One line about what is right, and one for each thing that looks wrong in measured data
// (fit/doubts.hpp); throws Failure with everything that is wrong. `kind` empty: kind_of(path).
std::string check_file(const std::string& path, std::string kind);

}  // namespace langer
