// Short names for the double that is not a number, and for infinity.
#pragma once

#include <limits>

namespace langer {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                        inf = std::numeric_limits<double>::infinity();

}  // namespace langer
