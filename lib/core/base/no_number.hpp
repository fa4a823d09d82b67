// What a double says where there is no number, or no end.
#pragma once

#include <limits>

namespace langer {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                        inf = std::numeric_limits<double>::infinity();

}  // namespace langer
