// Units as figures write them.
#pragma once

#include <string>

namespace langer {

// "travel (mm)", "angle (°)"; the label alone where the unit is -
inline std::string with_unit(const std::string& label, const std::string& unit) {
  const std::string sign = unit == "deg" ? "°" : unit == "percent" ? "%" : unit;
  return unit == "-" ? label : label + " (" + sign + ")";
}

}  // namespace langer
