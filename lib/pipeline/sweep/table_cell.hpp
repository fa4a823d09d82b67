// A number in a CSV table of a sweep.
#pragma once

#include <cmath>
#include <string>

#include "core/config/writer.hpp"

namespace langer {

// The shortest text that reads back the same; an empty cell for NaN, which means "not known".
inline std::string table_cell(double x) {
  if (std::isnan(x)) return "";
  return number_text(x);
}

}  // namespace langer
