// The part of a rigid sphere that may touch, as facets, for programs that know no exact sphere.
//   outer  corners of the facets; they lie by the mean sag s^2 / (6 R) of a facet of side s outside the sphere, so that facets
//          and sphere enclose the same volume
//   inner  one for each outer point, nearer the centre: between them lie hexahedra that carry the facets
#pragma once

#include <array>
#include <vector>

#include "core/tensor/types.hpp"
#include "mechanics/contact/shape.hpp"

namespace langer {

struct RigidCap {
  std::vector<Vec3> outer, inner;  // [mm], before the indenter moves
  std::vector<std::array<int, 4>>
      facets;       // of outer points, counter-clockwise seen from outside the sphere
  double side = 0;  // mean side of a facet [mm]
};

// towards: unit vector from the centre to the body. places: where, seen from the indenter's start,
// nodes may touch it [mm].
RigidCap rigid_cap(const Ball& sphere, const Vec3& towards, const std::vector<Vec3>& places,
                   double side);

}  // namespace langer
