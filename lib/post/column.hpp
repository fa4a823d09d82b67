// Name of a column of a table: the quantity and its unit, as in u_y_mm, mean_error_percent, d_per_MPa, c2.
#pragma once

#include <string>

namespace langer {

inline std::string column_name(const std::string& name, const std::string& unit) {
  if (unit.empty() || unit == "-") return name;
  return name + "_" + (unit.rfind("1/", 0) == 0 ? "per_" + unit.substr(2) : unit == "%" ? "percent" : unit);
}

}  // namespace langer
