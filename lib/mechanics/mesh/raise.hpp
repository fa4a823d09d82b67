// Cells of second order from those with fewer nodes: the new nodes are the middles of edges,
// facets and cells. For meshes whose nodes and cells have no names yet (sets, bodies, frames come
// later).
#pragma once

#include "mechanics/mesh/mesh.hpp"

namespace langer {

// connectivity: the corners of cells with straight edges, of as many for each cell as `to` has
Mesh raised(const std::vector<Vec3>& X, const std::vector<int>& connectivity, CellType to);
// connectivity: corners and middles of edges, which may be curved (hexahedra of 20 nodes,
// tetrahedra of 10); cells keep their shape
Mesh raised_with_edges(const std::vector<Vec3>& X, const std::vector<int>& connectivity,
                       CellType to);
Mesh raised(const Mesh& mesh, CellType to);  // of hex8

// Node sets from before the nodes from `first_new` on came: each takes those of an edge or facet of
// the surface, or of a cell, all of whose older nodes it has. (An edge within the body may lead
// from one side of it to another.)
void add_new_middles(Mesh& mesh, int first_new);

// What draws straight-edged cells only sees those between neighbouring nodes: the mesh itself,
// eight hex8 for each hex27, four for each tet15, one after the other. Nodes, positions and
// connectivity; bodies, frames and sets are left out.
Mesh between_nodes(const Mesh& mesh);

}  // namespace langer
