// What geometries have in common: the box that they span, and how cells grow away from a place.
#pragma once

#include <array>
#include <optional>
#include <vector>

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

// Meshes of one family: all cells of two of them differ by one factor, along each axis and between
// each two breaks. Breaks are where sets and loads end and where points lie; lines go through them
// on every mesh. Not for files.
struct MeshFamily {
  double length = 1;  // of the cells, in those that the numbers of the geometry give
  // Cells come in fours, or of coarser meshes of the family in threes and twos: so these are longer
  // by 4 / parts, exactly.
  int parts = 4;
  std::array<std::vector<double>, 3> breaks{};  // along x, y, z [mm]
};

}  // namespace langer
