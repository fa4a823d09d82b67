// Units as figures write them.
#pragma once

#include <string>

namespace langer {

// "travel (mm)", "angle (°)"; the label alone where the unit is -
inline std::string with_unit(const std::string& label, const std::string& unit) {
  std::string sign;
  if (unit == "deg") {
    sign = "°";
  } else if (unit == "percent") {
    sign = "%";
  } else {
    sign = unit;
  }
  if (unit == "-") return label;
  return label + " (" + sign + ")";
}

}  // namespace langer
