// A law as a material of CalculiX: *HYPERELASTIC for isotropic laws; fibres as its user material
// ELASTIC_FIBER, which knows a neo-Hookean matrix, undispersed families and at most four of them.
// Numbers are cut after 20 letters there, so none is longer.
#pragma once

#include <string>
#include <vector>

#include "export/foreign_law.hpp"
#include "mechanics/material/material.hpp"

namespace langer {

// Keywords that Abaqus and CalculiX share, without *MATERIAL; empty where an isotropic law is none
// of theirs.
std::string hyperelastic(const Material& material);

// fibres: directions of the families in the frame of the *ORIENTATION that the section names [-]
ForeignLaw calculix_material(const Material& material, const std::vector<Vec3>& fibres,
                             const std::string& name);

// name of the material: that of its user material must begin so
inline std::string calculix_name(const Material& material, const std::string& name) {
  return (material.fibres.empty() ? "" : "ELASTIC_FIBER_") + name;
}

}  // namespace langer
