// Where the supports of a config hold the body.
#pragma once

#include <string>

#include "scene/model/solve_config.hpp"

namespace langer {

bool is_at_bottom(const SupportConfig& support);

// Whether no support holds the bottom along y, as under a sheet that is held at its rims.
bool has_nothing_below(const SolveConfig& config);

// 0, 1, 2 for a side that is normal to x, y, z; -1 for another name.
int axis_of_side(const std::string& side);

}  // namespace langer
