// A place as messages name it: "(1.2, 0, -3) mm".
#pragma once

#include <fmt/format.h>

#include <string>

#include "core/tensor/types.hpp"

namespace langer {

inline std::string place_text(const Vec3& x) {
  return fmt::format("({:.3g}, {:.3g}, {:.3g}) mm", x[0], x[1], x[2]);
}

}  // namespace langer
