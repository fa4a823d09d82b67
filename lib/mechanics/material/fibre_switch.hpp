// Whether a fibre is slack (FibreSwitch in fibre.hpp).
#pragma once

#include <limits>

#include "mechanics/material/fibre.hpp"

namespace langer {

// At rest I4_bar is 1 up to the rounding of a a^T: such a fibre counts as stretched, so that the
// tangent at rest does not depend on the digits of cos(alpha).
inline constexpr double stretched_from = 1 - 16 * std::numeric_limits<double>::epsilon();

// not negative where the fibre is stretched; m = I3^(-1/3), I4_bar = m I4
template <class T>
T stretched(FibreSwitch tension_switch, const T& I4_bar, const T& m) {
  switch (tension_switch) {
    case FibreSwitch::I4_bar:
      return I4_bar - stretched_from;
    case FibreSwitch::I4:
      return I4_bar / m - stretched_from;
    case FibreSwitch::off:
      break;
  }
  return T(1.0);
}

}  // namespace langer
