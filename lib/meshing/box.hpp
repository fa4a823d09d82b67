// What geometries have in common: the box that they span, and how cells grow away from a place.
#pragma once

#include <array>

#include "core/base/fields.hpp"

namespace langer {

struct Box {
  std::array<double, 3> origin{}, size{};
};

struct TowardsCentre {
  double edge = 0, within = 0;
  static void fields(auto& v) {
    v(&TowardsCentre::edge, "edge", unit::mm, "length of the cells around the centre", required,
      positive);
    v(&TowardsCentre::within, "within", unit::mm,
      "distance from the centre up to which cells keep that length", at_least(0));
  }
};

struct TowardsTop {
  double edge = 0;
  static void fields(auto& v) {
    v(&TowardsTop::edge, "edge", unit::mm, "height of the uppermost cells", required, positive);
  }
};

}  // namespace langer
