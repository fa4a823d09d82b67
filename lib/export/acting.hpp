// Families that do nothing are left out of what other programs get: some divide by their modulus,
// some refuse it.
#pragma once

#include <span>
#include <vector>

#include "mechanics/material/material.hpp"

namespace langer {

inline Material acting(Material material) {
  std::erase_if(material.fibres, [](const Fibre& family) { return !acts(family); });
  return material;
}

// one for each family, in the order of the material -> those of the families that act
inline std::vector<Vec3> acting(const Material& material, std::span<const Vec3> fibres) {
  std::vector<Vec3> kept;
  for (std::size_t k = 0; k < material.fibres.size(); ++k)
    if (acts(material.fibres[k])) kept.push_back(fibres[k]);
  return kept;
}

}  // namespace langer
