// Facets of cells as loaded surfaces.
#pragma once

#include "core/tensor/types.hpp"
#include "mechanics/element/geometry.hpp"
#include "mechanics/mesh/mesh.hpp"

namespace langer {

// Adds the nodal forces of a dead traction [MPa, per reference area] on facets to F (3 n) [N].
void add_dead_traction(const Mesh& mesh, const std::vector<Facet>& facets, const Vec3& traction,
                       VecX& F);

// The share of each node in the area of facets in the reference state (n) [mm^2]: integral N_a dA.
// The sum over the nodes is the area.
VecX nodal_areas(const Mesh& mesh, const std::vector<Facet>& facets);

// Nodal forces of a cell, one row per node [N], of a dead traction [MPa, per reference area] on one
// of its facets.
ElementNodes dead_traction(const ReferenceCell& cell, int facet, const ElementNodes& X,
                           const Vec3& traction);
// The same of a pressure of 1 MPa that follows its facet and pushes into the cell:
//   f_a = -integral N_a x,1 x x,2                    x (nodes, 3): where the cell's nodes are now   [Wriggers, section 4.2.5]
ElementNodes follower_pressure(const ReferenceCell& cell, int facet, const ElementNodes& x);
// The symmetric part of df/dx, (3 nodes, 3 nodes) [N/mm]. The rest is skew and is an integral over
// the rim of the facet: it cancels at edges that two loaded facets share, and vanishes where the
// rim is held.
MatX follower_stiffness(const ReferenceCell& cell, int facet, const ElementNodes& x);
// The skew part of df/dx times dx [N]: what follower_stiffness leaves of the change of
// follower_pressure where the nodes move by dx.
ElementNodes follower_skew_change(const ReferenceCell& cell, int facet, const ElementNodes& x,
                                  const ElementNodes& dx);

}  // namespace langer
