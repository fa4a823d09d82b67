// The penetration check of two surfaces, node by node and on both sides. The mortar law closes gaps
// on average; single nodes may be inside the other body by what the meshes do not resolve.
#pragma once

#include "mechanics/mortar/surface_contact.hpp"

namespace langer {

// the deepest node of either side behind a facet of the other one that it lies over [mm]; 0: none
double penetration(const SurfaceContact& contact, const VecX& x);

}  // namespace langer
