// Rigid motions of the whole body that its supports and imposed displacements leave free: only
// contact can hold it then, and where contact does not resist either (a frictionless sphere and a
// turn about its axis), there is no unique equilibrium.
#pragma once

#include <string>

#include "mechanics/assembly/dofs.hpp"
#include "mechanics/mesh/mesh.hpp"

namespace langer {

std::string zero_energy_modes(const Mesh& mesh,
                              const Dofs& dofs);  // in words; empty where the body is held

}  // namespace langer
