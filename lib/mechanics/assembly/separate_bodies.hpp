// Bodies of one mesh that share no node, and what their supports leave free of each.
#pragma once

#include <string>
#include <vector>

#include "mechanics/assembly/dofs.hpp"
#include "mechanics/mesh/mesh.hpp"

namespace langer {

// nodes of each, ascending; bodies in the order of their first node
std::vector<std::vector<int>> separate_bodies(const Mesh& mesh);

// rigid motions that the prescribed displacements leave to these nodes, in words as
// zero_energy_modes() says; empty where there is none
std::string free_motions(const Mesh& mesh, const Dofs& dofs, const std::vector<int>& nodes);

// whether any of them can move as a rigid body
bool any_is_free(const Mesh& mesh, const Dofs& dofs);

}  // namespace langer
