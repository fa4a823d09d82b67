// Adhesion of an indenter or a surface in a scene: which candidates have how much of the body's
// surface, and whether cells resolve the bonds.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/mesh/mesh.hpp"
#include "mechanics/mortar/surface_contact.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

// Gives `rigid`, whose nodes are known, the adhesion of its config; none with work: 0, which holds
// nothing.
void take_adhesion(RigidContact& rigid, const ContactConfig& contact, const Mesh& mesh,
                   const std::string& key, const std::function<Place(const std::string&)>& where,
                   std::vector<Error>& errors);

// The same for surfaces that touch. A candidate has the area that is covered at rest, or else all
// of the facets around it. Errors: bonds that hold further than opposite facets are looked for.
void take_adhesion(SurfaceContact& surface, const ContactConfig& contact, const Mesh& mesh,
                   const std::vector<Facet>& own, const std::string& key,
                   const std::function<Place(const std::string&)>& where,
                   std::vector<Error>& errors);

// Bonds come loose over a length of about E* w / sigma_max^2 = E*/C_N behind the edge of the
// contact, E* = 4 mu of an incompressible body. [mm]: the shortest cell side under the candidates,
// and that length in the softest material
struct BondZone {
  double cell = 0, length = 0;
  double longest_cell() const {
    return length / 8;
  }  // beyond, the edge of the contact jumps from node to node
  bool resolved() const { return cell <= longest_cell(); }
};
BondZone bond_zone(const Adhesion& adhesion, const std::vector<int>& candidates, const Mesh& mesh,
                   const std::vector<Material>& materials);

}  // namespace langer
