// Volumetric energy  U = kappa/4 (J^2 - 1 - 2 ln J)                                    [ST91],
// [H00] with beta = -2 Convex for every J > 0, infinite where the volume vanishes; what Abaqus
// takes with Holzapfel's and Arruda-Boyce's laws.
#pragma once

#include <cmath>

#include "core/base/fields.hpp"
#include "core/base/search_bounds.hpp"
#include "core/tensor/packet.hpp"
#include "mechanics/material/energy.hpp"

namespace langer {

// x - ln(1 + x) with all its digits: with r = x/(2 + x), ln(1 + x) = 2 (r + r^3/3 + r^5/5 + ...)
// and x - 2 r = x r
template <class T>
T minus_its_logarithm(T x) {
  using std::log1p;
  if (!within(x, 0.1)) return x - log1p(x);
  const T r = x / (2.0 + x);
  const T s = r * r;
  const T series =
      1. / 3 +
      s * (1. / 5 + s * (1. / 7 + s * (1. / 9 + s * (1. / 11 + s * (1. / 13 + s * (1. / 15))))));
  return r * (x - 2.0 * s * series);
}

struct SimoTaylorVolume {
  static constexpr const char* key = "simo_taylor";
  double bulk_modulus = 0;
  static void fields(auto& v) {
    v(&SimoTaylorVolume::bulk_modulus, "bulk_modulus", unit::MPa,
      "kappa of U = kappa/4 (J^2 - 1 - 2 ln J)", required, positive, SearchBounds{0.2, 2e8});
  }
  // of J - 1, without cancellation
  template <class T>
  Energy<T> at_volume_change(T J_minus_1) const {
    const T x = J_minus_1;
    const T inverse = 1.0 / (1.0 + x);
    return {(0.25 * bulk_modulus) * (x * x + 2.0 * minus_its_logarithm(x)),
            (0.5 * bulk_modulus) * (x + x * inverse),
            (0.5 * bulk_modulus) * (1.0 + inverse * inverse)};
  }
  template <class T>
  Energy<T> operator()(T J) const {
    return at_volume_change(T(J - 1.0));
  }
};

}  // namespace langer
