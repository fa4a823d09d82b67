// The inertia of a body, as the solve stage's YAML may name it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"

namespace langer {

// Density of the undeformed bodies: a number, or a map by the names of bodies.
//   density_kg_m3: 1100
//   density_kg_m3: {dermis: 1100, fat: 950}
struct Densities {
  static constexpr const char* short_key = "all";
  static constexpr const char* map_key = "bodies";
  std::optional<double> all;
  std::map<std::string, double> bodies;
  static void fields(auto& v) {
    constexpr Range of_solids{50, 30000, true, true};
    const Hint per_m3{
        "in kg/m3: skin has about 1100 kg/m3, which is 1.1 g/cm3 or 1.1e-9 t/mm3"};
    v(&Densities::all, "all", "kg/m3", "of every body that is not named", of_solids, per_m3);
    v(&Densities::bodies, "bodies", "kg/m3", "of a body of the mesh", of_solids, per_m3);
  }
  std::vector<Complaint> complaints() const {
    if (all || !bodies.empty()) return {};
    return {{"", "found no density", "a number in kg/m3, or one for each body", ""}};
  }
};

struct DynamicsConfig {
  std::optional<Densities> density_kg_m3;
  static void fields(auto& v) {
    v(&DynamicsConfig::density_kg_m3, "density_kg_m3", "kg/m3",
      "of the undeformed bodies: a number, or a map {dermis: 1100, fat: 950}", required);
  }
};

}  // namespace langer
