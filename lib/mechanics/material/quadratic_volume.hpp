// Volumetric energy  W = (J - 1)^2 / d, bulk modulus kappa = 2/d.                      [A23] eq. 15
#pragma once

#include "core/base/fields.hpp"
#include "mechanics/material/energy.hpp"

namespace langer {

struct QuadraticVolume {
  static constexpr const char* key = "quadratic";
  static constexpr bool linear_pressure = true;  // U' is linear in J
  double d = 0;
  static void fields(auto& v) {
    v(&QuadraticVolume::d, "d", unit::per_MPa, "compressibility: 2/d is the bulk modulus", required,
      positive, Hint{"[A23] uses 1e-6; its tables were made with 2e-3 (FER) and 4.4e-4 (ANSYS)"});
  }
  double bulk_modulus() const { return 2 / d; }  // [MPa]
  // as a function of J - 1, which the caller knows without cancellation
  template <class T>
  Energy<T> at_volume_change(T J_minus_1) const {
    return {J_minus_1 * J_minus_1 / d, 2 / d * J_minus_1, T{} + 2 / d};
  }
  template <class T>
  Energy<T> operator()(T J) const {
    return at_volume_change(T(J - 1.0));
  }
};

}  // namespace langer
