// Structured hexahedra without a mesher. Nodes and cells in order: by (y, z, x), x fastest; xi,
// eta, zeta along x, y, z.
#pragma once

#include <array>
#include <vector>

#include "mechanics/mesh/mesh.hpp"

namespace langer {

using GridLines = std::array<std::vector<double>, 3>;  // of x, y, z; ascending

Mesh hexahedra_between(const GridLines& lines);

// Quadrangles in the x-z plane, each counter-clockwise from -y: edges along x, then along z.
struct Plan {
  std::vector<std::array<double, 2>> points;  // x, z
  std::vector<std::array<int, 4>> cells;
};

// Hexahedra above the plan, a layer between neighbouring heights; in the plan's order within each
// layer.
Mesh extruded(const Plan& plan, const std::vector<double>& heights);

}  // namespace langer
