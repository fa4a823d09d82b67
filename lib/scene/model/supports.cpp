#include "scene/model/supports.hpp"

#include <algorithm>

namespace langer {

bool is_at_bottom(const SupportConfig& support) {
  return support.on == "bottom" || support.on == "y_min";
}

bool has_nothing_below(const SolveConfig& config) {
  return std::ranges::none_of(config.supports, [](const SupportConfig& support) {
    return is_at_bottom(support) && std::ranges::count(support.hold, Axis::y) > 0;
  });
}

int axis_of_side(const std::string& side) {
  if (side == "top" || side == "bottom") return 1;
  for (const char* end : {"_min", "_max"})
    for (int axis = 0; axis < 3; ++axis)
      if (side == std::string(1, "xyz"[axis]) + end) return axis;
  return -1;
}

}  // namespace langer
