// How far an indenter that is pushed along a direction goes until it touches.
#pragma once

#include <functional>
#include <optional>

#include "contact/contact.hpp"

namespace langer {

// Travel at which the nearest candidate is touched, t and `from` to begin with [mm]; nothing where it passes all of them by.
// position: of a node [mm]. Under force control.
std::optional<double> travel_to_touch(const RigidContact& contact, double t, double from,
                                      const std::function<Vec3(int node)>& position);

}  // namespace langer
