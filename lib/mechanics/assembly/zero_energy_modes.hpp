// Rigid motions of the whole body that its supports and imposed displacements leave free: only
// contact can hold it then, and where contact does not resist either (a frictionless sphere and a
// turn about its axis), there is no unique equilibrium.
#pragma once

#include <string>

#include "mechanics/assembly/dofs.hpp"
#include "mechanics/mesh/mesh.hpp"

namespace langer {

struct RigidMotions {
  int along = 0, about = 0;  // translations and rotations that are free
  std::string words;         // empty where the body is held
};
RigidMotions rigid_motions(const Mesh& mesh, const Dofs& dofs);
std::string zero_energy_modes(const Mesh& mesh, const Dofs& dofs);  // their words

}  // namespace langer
