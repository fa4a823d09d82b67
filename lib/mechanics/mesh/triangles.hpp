// A surface of triangles: of a rigid indenter, of an STL file.
#pragma once

#include <array>
#include <vector>

#include "core/tensor/types.hpp"

namespace langer {

struct Triangles {
  std::vector<Vec3> points;                 // [mm]
  std::vector<std::array<int, 3>> corners;  // counter-clockwise seen from outside
};

}  // namespace langer
