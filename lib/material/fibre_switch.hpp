// Whether a fibre is slack (FibreSwitch in material.hpp).
#pragma once

#include <limits>

#include "material/material.hpp"

namespace langer {

// At rest I4_bar is 1 up to the rounding of a a^T: such a fibre counts as stretched, so that the tangent at rest does
// not depend on the digits of cos(alpha).
inline constexpr double stretched_from = 1 - 16 * std::numeric_limits<double>::epsilon();

inline bool slack(FibreSwitch tension_switch, double I4, double I4_bar) {
  switch (tension_switch) {
    case FibreSwitch::I4_bar:
      return I4_bar < stretched_from;
    case FibreSwitch::I4:
      return I4 < stretched_from;
    case FibreSwitch::off:
      return false;
  }
  return false;
}

}  // namespace langer
