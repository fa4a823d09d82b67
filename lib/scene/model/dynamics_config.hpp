// The inertia of a body, as the solve stage's YAML may name it.
#pragma once

#include <map>
#include <string>

#include "core/base/fields.hpp"

namespace langer {

struct DynamicsConfig {
  double density_kg_m3 = 0;
  std::map<std::string, double> densities_kg_m3;
  static void fields(auto& v) {
    v(&DynamicsConfig::density_kg_m3, "density_kg_m3", "kg/m^3",
      "of the undeformed bodies; skin has about 1100", required, between(10, 30000),
      Hint{"in kg/m3: 1.1 g/cm3 and 1.1e-9 t/mm3 are 1100"});
    v(&DynamicsConfig::densities_kg_m3, "densities_kg_m3", "kg/m^3",
      "of single bodies by name, in the place of density_kg_m3", between(10, 30000),
      Hint{"in kg/m3: 1.1 g/cm3 and 1.1e-9 t/mm3 are 1100"});
  }
};

}  // namespace langer
