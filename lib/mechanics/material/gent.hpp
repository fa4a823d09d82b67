// Gent's law of limited extension [G96]:  W = -mu Jm/2 ln(1 - x/Jm),  x = I1_bar - 3 < Jm.
//   mu [MPa] shear modulus at rest; Jm [-] > 0 value of x at which the chains are straight
// Beyond Jm no energy exists: W and its derivatives are then NaN, which solvers take for "no state
// here".
#pragma once

#include <cmath>

#include "core/base/fields.hpp"
#include "core/base/search_bounds.hpp"
#include "mechanics/material/energy.hpp"

namespace langer {

struct Gent {
  static constexpr const char* key = "gent";
  static constexpr Invariant of = Invariant::I1_bar;
  double mu = 0, Jm = 1;
  static void fields(auto& v) {
    v(&Gent::mu, "mu", unit::MPa, "shear modulus at rest", required);
    v(&Gent::Jm, "Jm", unit::none, "value of (I1_bar - 3) at which the stress becomes infinite",
      required, positive, SearchBounds{0.1, 200});
  }
  template <class T>
  Energy<T> operator()(T I1_bar) const {
    using std::exp, std::log1p;
    const T L = log1p(T((3.0 - I1_bar) * (1 / Jm)));
    const T steeper = exp(-L);  // 1/(1 - x/Jm), NaN where the logarithm is
    return {(-0.5 * mu * Jm) * L, (0.5 * mu) * steeper, (0.5 * mu / Jm) * steeper * steeper};
  }
};

}  // namespace langer
