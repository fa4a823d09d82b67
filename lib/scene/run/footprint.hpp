// Where indenters press the top of a block: the part of it, at rest, that lies inside one of them
// somewhere on its way. Cells are wanted there, wherever it is.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "scene/model/solve_config.hpp"

namespace langer {

struct Footprint {
  std::array<double, 2> low{}, high{};  // x and z [mm], within the top
  double deepest = 0;                   // how far an indenter goes below the top [mm]
  double middle(int k) const { return 0.5 * (low[k] + high[k]); }
  double half(int k) const { return 0.5 * (high[k] - low[k]); }
};

// of each contact that reaches the top at rest. A surface from a file (stl) is not looked at.
std::vector<Footprint> footprints(const SolveConfig& config, const Box& body);
// of all contacts together; nothing where none reaches it
std::optional<Footprint> footprint(const SolveConfig& config, const Box& body);

}  // namespace langer
