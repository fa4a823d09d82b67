// The part of a rigid sphere that may touch the body, as facets, for programs without an exact
// sphere.
//   outer  corners of the facets, outside the sphere by the mean sag s^2 / (6 R) of a facet with
//          side s, so that facets and sphere enclose the same volume
//   inner  one for each outer point, closer to the centre: hexahedra between them carry the facets
#pragma once

#include <array>
#include <vector>

#include "core/tensor/types.hpp"
#include "mechanics/contact/shape.hpp"

namespace langer {

struct RigidCap {
  std::vector<Vec3> outer, inner;  // [mm], before the indenter moves
  // Corners are numbers of outer points, counter-clockwise seen from outside the sphere.
  std::vector<std::array<int, 4>> facets;
  double side = 0;  // mean side of a facet [mm]
};

// `towards` is the unit vector from the centre to the body. `places` are the positions of nodes
// that may touch the sphere, relative to its start [mm].
RigidCap rigid_cap(const Ball& sphere, const Vec3& towards, const std::vector<Vec3>& places,
                   double side);

}  // namespace langer
