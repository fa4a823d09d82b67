// Laws of volume change: U(J), an alternative each. One more is its header and its name in the
// list.
//   at_volume_change(J - 1) -> U, dU/dJ = mean stress p [MPa], d2U/dJ2;   at J = 1 the latter is the bulk modulus
#pragma once

#include <variant>

#include "mechanics/material/existence.hpp"
#include "mechanics/material/logarithmic_volume.hpp"
#include "mechanics/material/quadratic_volume.hpp"
#include "mechanics/material/simo_taylor_volume.hpp"

namespace langer {

using Volume = std::variant<QuadraticVolume, LogarithmicVolume, SimoTaylorVolume>;

template <class T>
Energy<T> volume_energy(const Volume& volume, const T& J_minus_1) {
  return std::visit(
      [&](const auto& law) { return law.at_volume_change(nan_outside_domain(law, J_minus_1)); },
      volume);
}

inline double bulk_modulus(const Volume& volume) {
  return volume_energy(volume, 0.).ddW;
}  // at rest [MPa]

// p = kappa (J - 1) for every J
inline bool linear_pressure(const Volume& volume) {
  return std::visit(
      [](const auto& law) {
        return requires { law.linear_pressure; };
      },
      volume);
}

}  // namespace langer
