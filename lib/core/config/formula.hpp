// A formula of x, y and z given as text, such as "30 + 2*x". muParser stays behind formula.cpp.
// Its functions (sin, cos, atan2, sqrt, min, max, ...) take radians; _pi is a constant.
// Refused as Failure(config) at `where`, with the position in the text: what muParser cannot read,
// and values not finite.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace langer {

struct FormulaPoint {
  double x, y, z;
};

std::vector<double> evaluate(const std::string& formula, const std::vector<FormulaPoint>& points,
                             const Place& where, const std::string& key);

}  // namespace langer
