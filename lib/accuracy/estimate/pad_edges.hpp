// Pads: bodies whose face ends within the face of the body that they touch.
//
// At the edge of a pad stresses are singular, and errors fall with the length h of the other body's
// cells alone. If the edge lies between its grid lines, the width over which the pad presses is
// only known to a share of h. Three meshes may then agree by chance: their lines lie elsewhere.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "scene/model/solve_config.hpp"

namespace langer {

// Edges of pads on a block, one of several bodies: places along x, y, z [mm], at rest. A face is
// known by the name of its side, as pad_bottom and skin_top.
std::array<std::vector<double>, 3> pad_edges_on(const SolveConfig& config, const std::string& body);

bool has_pads(const SolveConfig& config);

// Lower limit of the error bar of contact forces and reactions, as a share of the value:
//   C h / w,   w: the shorter side of the pad
// C = 0.35 for pads up to 2.5 times as stiff as the other body, growing to 1.5 for those 100 times
// as stiff. Pads of 0.4, 2.5 and 100 times the stiffness, with friction and without, on seven
// meshes each, had errors of up to 0.28, 0.29 and 1.33 h / w. 0 where grid lines meet all edges on
// the three meshes of an estimate.
double beside_pads(const SolveConfig& config);

}  // namespace langer
