// Fibre families without stiffness are not given to other programs: some of them divide by the
// modulus, some refuse 0.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "mechanics/material/material.hpp"

namespace langer {

// The material without such families.
inline Material acting(Material material) {
  std::erase_if(material.fibres, std::not_fn(acts));
  return material;
}

// The directions of the families that act. `fibres` has one for each family of the material.
inline std::vector<Vec3> acting(const Material& material, std::span<const Vec3> fibres) {
  std::vector<Vec3> kept;
  for (std::size_t k = 0; k < material.fibres.size(); ++k)
    if (acts(material.fibres[k])) kept.push_back(fibres[k]);
  return kept;
}

}  // namespace langer
