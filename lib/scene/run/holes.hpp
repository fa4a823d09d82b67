// What the hole that a body is sucked into, and the end of what is held, leave open of an error
// bar, where three meshes do not tell it.          docs/loads.md, docs/study_estimates.md
#pragma once

#include <string>

#include "scene/model/solve_config.hpp"

namespace langer {

// Least shares of a bar in its quantity: in the force of a plate with a hole, in a height under
// such a plate, in one under a ring that is held (clamped: a face is held in its plane, too). 0
// where the scene has none. Of a config that holds its mesh.
double beside_holes(const SolveConfig& config);
double under_holes(const SolveConfig& config);
double beside_rims(const SolveConfig& config, bool clamped);
// Least share of a bar where a part of a face is held or moved, and the rest of it not, as behind
// the tip of a crack.
double beside_ends_of_supports(const SolveConfig& config);

// Why no bar is told of displacement_<point>, where it may slip over the rounded edge of a plate;
// empty otherwise.
std::string over_an_edge(const SolveConfig& config, const std::string& quantity);

}  // namespace langer
