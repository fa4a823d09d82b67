// A stage's config as its program takes it, and what its result says of it. Compiled once for each
// type, in effective.cpp: it took the compiler ten seconds in each program.
#pragma once

#include <string>
#include <vector>

#include "core/config/reader.hpp"
#include "core/config/writer.hpp"

namespace langer {

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
