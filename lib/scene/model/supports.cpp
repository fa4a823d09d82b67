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

}  // namespace langer
