// A material as CalculiX has it: *HYPERELASTIC for isotropic models, and its user material
// ELASTIC_FIBER for fibres, which has a neo-Hookean matrix and at most four families without
// dispersion. CalculiX ignores digits after the 20th letter of a number, so no number is longer.
#pragma once

#include <string>
#include <vector>

#include "export/foreign_law.hpp"
#include "mechanics/material/material.hpp"

namespace langer {

// The keywords that Abaqus and CalculiX share, without *MATERIAL; empty if neither has this
// isotropic model.
std::string hyperelastic(const Material& material);

// `fibres` are the directions of the families in the frame of the *ORIENTATION that the section
// names [-].
ForeignLaw calculix_material(const Material& material, const std::vector<Vec3>& fibres,
                             const std::string& name);

// The name of the material. CalculiX recognises its user material by the begin of the name.
inline std::string calculix_name(const Material& material, const std::string& name) {
  if (material.fibres.empty()) return name;
  return "ELASTIC_FIBER_" + name;
}

}  // namespace langer
