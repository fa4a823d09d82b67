// Volumetric energy  U = kappa/2 (ln J)^2                                              [H00]
// Infinite where the volume vanishes; convex in J up to J = e only.
#pragma once

#include <cmath>

#include "core/base/fields.hpp"
#include "core/base/search_bounds.hpp"
#include "mechanics/material/energy.hpp"

namespace langer {

struct LogarithmicVolume {
  static constexpr const char* key = "logarithmic";
  double bulk_modulus = 0;
  static void fields(auto& v) {
    v(&LogarithmicVolume::bulk_modulus, "bulk_modulus", unit::MPa, "kappa of U = kappa/2 (ln J)^2",
      required, positive, SearchBounds{0.2, 2e8});
  }
  // of J - 1, without cancellation
  template <class T>
  Energy<T> at_volume_change(T J_minus_1) const {
    using std::log1p;
    const T L = log1p(J_minus_1);
    const T inverse = 1.0 / (1.0 + J_minus_1);
    const T slope = bulk_modulus * inverse;
    return {(0.5 * bulk_modulus) * L * L, slope * L, slope * inverse * (1.0 - L)};
  }
  template <class T>
  Energy<T> operator()(T J) const {
    return at_volume_change(T(J - 1.0));
  }
};

}  // namespace langer
