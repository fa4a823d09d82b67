// Reads the config of a stage for its program: values, places of keys, and the text that is stored
// with the result. The template is compiled once for each type in effective.cpp, because it takes
// the compiler ten seconds.
#pragma once

#include <string>
#include <vector>

#include "core/config/reader.hpp"
#include "core/config/writer.hpp"

namespace langer {

// A config that was read: places of its keys, warnings, and its text for the result file.
struct ReadConfig {
  Where where;
  std::vector<std::string> notices;  // keys and words by their former names
  ConfigText text;
  std::vector<ConfigPart> parts;
};

// Of the config types of stages only. Throws Failure(config).
template <class Config>
ReadConfig read_stage_config(Tree tree, Config& config);

}  // namespace langer
