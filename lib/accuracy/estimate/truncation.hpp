// What a block or disc leaves out that stands for a larger body: the scene on bodies 1.5 and 2.25
// times as wide, or as thick, on cells that are the same near the indenter. From the three forces
// f1, f2, f3 the limit follows where their differences fall:
//   f = f3 + d2 r / (1 - r),   d1 = f2 - f1,  d2 = f3 - f2,  r = d2 / d1
#pragma once

#include <array>

#include "scene/model/solve_config.hpp"

namespace langer {

// of a mesh that may_be_truncated; `on` keeps its name and moves along
std::array<SolveConfig, 2> wider(const SolveConfig& config, Truncation truncation);

// f1 less its limit; where the differences do not fall by a fifth at least, both of them together
// with the sign of their sum
double beyond(double f1, double f2, double f3);

}  // namespace langer
