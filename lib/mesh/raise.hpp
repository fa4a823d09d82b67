// Cells of second order from those of first order, with straight edges: the new nodes lie in the middles of edges, facets and
// cells. For meshes whose nodes and cells have no names yet (sets, bodies, frames come later).
#pragma once

#include "mesh/mesh.hpp"

namespace langer {

// connectivity: the corners only, of as many for each cell as `to` has
Mesh raised(const std::vector<Vec3>& X, const std::vector<int>& connectivity, CellType to);
Mesh raised(const Mesh& mesh, CellType to);  // of hex8

// What draws straight-edged cells only sees those between neighbouring nodes: the mesh itself, eight hex8 for each hex27, four for each tet15, one
// after the other. Nodes, positions and connectivity; bodies, frames and sets are left out.
Mesh between_nodes(const Mesh& mesh);

}  // namespace langer
