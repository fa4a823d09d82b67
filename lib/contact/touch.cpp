#include "contact/touch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace langer {

// The gap is a distance: a movement by it meets nothing, so that steps of it come to the touch, or go by for ever.
std::optional<double> travel_to_touch(const RigidContact& contact, double t, double from,
                                      const std::function<Vec3(int node)>& position) {
  const auto gap = [&](double travel) {
    const Vec3 c = indenter_displacement(contact, t, travel);
    double least = std::numeric_limits<double>::infinity();
    for (int node : contact.nodes) least = std::min(least, shape_at(contact.shape, position(node) - c).gap);
    return least;
  };
  if (contact.nodes.empty()) return std::nullopt;
  const double size = 1 + std::abs(gap(from));
  double travel = from;
  for (int i = 0; i < 10000 && std::abs(travel - from) < 1e6 * size; ++i) {
    const double g = gap(travel);
    if (std::abs(g) <= 1e-12 * size) return travel;
    travel += g;
  }
  return std::nullopt;
}

}  // namespace langer
