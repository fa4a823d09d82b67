// Whether loads act on the area that their sets describe. A set holds whole facets: where no grid
// lines run along the edges of its box, its area is another one.
#pragma once

#include <string>
#include <vector>

#include "scene/model/solve_config.hpp"

namespace langer {

// of the whole facets of a set, at rest [mm^2]; 0 where it has none
double area_of(const Mesh& mesh, const std::string& set);

// A sentence for each pressure or traction on a part of a side of a block whose facets have more
// than 5 % more or less area than this part. Nothing where the config holds no block.
std::vector<std::string> loads_on_other_areas(const SolveConfig& config, const Mesh& mesh);

}  // namespace langer
