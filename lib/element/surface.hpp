// Facets of cells as loaded surfaces.
#pragma once

#include "mesh/mesh.hpp"
#include "tensor/types.hpp"

namespace langer {

// Adds the nodal forces of a dead traction [MPa, per reference area] on facets to F (3 n) [N].
void add_dead_traction(const Mesh& mesh, const std::vector<Facet>& facets, const Vec3& traction, VecX& F);

// What each node of facets has of their area in the reference state (n) [mm^2]: integral N_a dA. Their sum is the area.
VecX nodal_areas(const Mesh& mesh, const std::vector<Facet>& facets);

}  // namespace langer
