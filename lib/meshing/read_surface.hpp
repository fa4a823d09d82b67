// Reads a surface of triangles from an STL file (text or binary); corners that lie together to 1e-8
// of its size are one. Throws Failure(input): a file that is not one, no triangles, a triangle
// without area, coordinates that are not finite.
#pragma once

#include <string>

#include "core/base/error.hpp"
#include "mechanics/mesh/triangles.hpp"

namespace langer {

Triangles read_surface(const std::string& path);
Triangles parse_surface(const std::string& bytes, const std::string& shown_name);

}  // namespace langer
