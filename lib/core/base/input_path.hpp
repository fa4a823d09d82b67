// A config value that names an input file, such as a measured curve.
// In YAML the path is relative to the file it is written in; in here it is relative to the working
// directory, or absolute. What the file holds belongs to the identity of a result, where the file
// lies does not (pipeline/plan/run_files.hpp).
#pragma once

#include <string>

namespace langer {

struct InputPath {
  std::string path;
};

}  // namespace langer
