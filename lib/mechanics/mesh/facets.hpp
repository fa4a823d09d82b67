// Facets of cells as nodes.
#pragma once

#include <array>
#include <vector>

#include "mechanics/mesh/mesh.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

// as mesh/reference.hpp orders them: corners counter-clockwise from outside, middles of edges, the
// middle
std::vector<int> facet_nodes(const Mesh& mesh, const Facet& facet);
// its corners only, ascending: the same for the two cells that share it; a triangle's begin with -1
std::array<int, 4> facet_key(const Mesh& mesh, const Facet& facet);
// quadrilaterals that together are the facet, between neighbouring nodes: one, three or four
std::vector<std::array<int, 4>> facet_quads(const Mesh& mesh, const Facet& facet);

}  // namespace langer
