// Reads a surface of triangles from an STL file (text or binary) through gmsh.
// Throws Failure(input): a file that is not one, no triangles, a triangle without area, coordinates that are not finite.
#pragma once

#include <string>

#include "base/error.hpp"
#include "tensor/types.hpp"

namespace langer {

struct SurfaceFile {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> corners;
};

SurfaceFile read_surface(const std::string& path);

}  // namespace langer
