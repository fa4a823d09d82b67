// Reading of the configs of fits, compiled once (as in scene/model/solve_config_io.hpp).
#pragma once

#include "core/config/reader.hpp"
#include "core/config/writer.hpp"
#include "identification/setup/fit_config.hpp"

namespace langer {

extern template Loaded<FitConfig> read_config(Tree);
extern template Tree to_tree(const FitConfig&, const PathText&);

}  // namespace langer
