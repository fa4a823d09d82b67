// Units as figures write them.
#pragma once

#include <string>

namespace langer {

// "travel (mm)", "angle (°)"; the label alone if the unit is -
inline std::string with_unit(const std::string& label, const std::string& unit) {
  if (unit == "-") return label;
  if (unit == "deg") return label + " (°)";
  if (unit == "percent") return label + " (%)";
  return label + " (" + unit + ")";
}

}  // namespace langer
