// A face of a hexahedron as a loaded surface.
#pragma once

#include "mesh/mesh.hpp"
#include "tensor/types.hpp"

namespace langer {

// Adds the nodal forces of a dead traction [MPa, per reference area] on facets to F (3 n) [N].
void add_dead_traction(const Mesh& mesh, const std::vector<Facet>& facets, const Vec3& traction, VecX& F);

}  // namespace langer
