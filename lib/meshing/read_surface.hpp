// Reads a surface of triangles from an STL file (text or binary); corners that lie together to 1e-8
// of its size are one. Throws Failure(input): a file that is not one, no triangles, a triangle
// without area, coordinates that are not finite.
#pragma once

#include <string>

#include "core/base/error.hpp"
#include "mechanics/mesh/triangles.hpp"

namespace langer {

// A triangle without area has no normal, which an indenter needs. The surface of a solid that is to
// be meshed does not: triangles two of whose corners are one are left out, others stay.
enum class FlatTriangles { refused, allowed };

Triangles read_surface(const std::string& path, FlatTriangles flat = FlatTriangles::refused);
Triangles parse_surface(const std::string& bytes, const std::string& shown_name,
                        FlatTriangles flat = FlatTriangles::refused);

}  // namespace langer
