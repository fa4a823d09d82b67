// Reads a surface of triangles from an STL file (text or binary); corners that lie together to 1e-8 of its size are one.
// Throws Failure(input): a file that is not one, no triangles, a triangle without area, coordinates that are not finite.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "tensor/types.hpp"

namespace langer {

struct SurfaceFile {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> corners;
};

SurfaceFile read_surface(const std::string& path);
SurfaceFile parse_surface(const std::string& bytes, const std::string& shown_name);

}  // namespace langer
