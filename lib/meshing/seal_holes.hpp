// Fills small holes of a surface of triangles, as scanners leave them.
#pragma once

#include <optional>
#include <vector>

#include "mechanics/mesh/triangles.hpp"

namespace langer {

// A closed chain of edges that belong to one triangle each.
struct Hole {
  std::vector<int> points;  // in the order in which triangles that fill it would run
  double width = 0;         // largest distance of two of its points [mm]
  Vec3 middle = Vec3::Zero();
};

// Holes whose edges form simple chains; where chains meet in a point there is no telling which.
std::vector<Hole> holes_of(const Triangles& surface);

// Adds triangles between the points of the hole: of all triangulations that with the least area.
// False where it has too many points.                      [Barequet and Sharir 1995; Liepa 2003]
bool fill(const Hole& hole, Triangles& surface);

}  // namespace langer
