// Checks a YAML file (a config, a material or a pipeline) without running anything.
#pragma once

#include <string>

namespace langer {

// The kind of a file, such as "solve" or "pipeline": from the line that names its schema, otherwise
// from its keys. Throws Failure(config) if neither is enough.
std::string kind_of(const std::string& path);

// One line that names the kind of the file, and one for each doubt about measured data
// (fit/doubts.hpp). Throws Failure with all errors. If `kind` is empty, it is kind_of(path).
std::string check_file(const std::string& path, std::string kind);

}  // namespace langer
