// Checks a material as a whole for doubtful values, before anything is solved.
//
// Each parameter of a material can be valid, and the material still not be the intended one. The
// bulk modulus K and the shear modulus mu at rest give Poisson's ratio
//   nu = (3 K - 2 mu) / (2 (3 K + mu))
// Soft tissue has 0.49 to 0.5. Below 0 a body grows sideways when it is pulled: mostly a bulk
// modulus was typed for d = 2/K. Fibres of energies in I4_bar let a body change its volume if K is
// not much larger than their stiffness (Helfenstein et al. 2010, Nolan et al. 2014). A very large
// K/mu leaves few digits of the stress.
#pragma once

#include <string>
#include <vector>

#include "mechanics/material/material.hpp"

namespace langer {

struct MaterialFinding {
  std::string key;    // path of the number below the material
  std::string words;  // the finding, its consequence, and what may have been meant
};

double poisson_ratio(double bulk_modulus, double shear_modulus);
double poisson_ratio(const Material& material);  // at rest, of the matrix and the volume term

// Stiffness of the stiffest family along its fibres at rest, d2W/dE2 [MPa]; 0 without fibres.
double fibre_stiffness(const Material& material);

// The key of the volume term and its value for a bulk modulus: "volume.quadratic.d: 0.002".
std::string volume_key(const Volume& volume, double bulk_modulus);

std::vector<MaterialFinding> review(const Material& material);

}  // namespace langer
