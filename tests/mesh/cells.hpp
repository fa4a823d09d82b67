// Single cells and small blocks for tests of sets, frames and quality.
#pragma once

#include <Eigen/Geometry>

#include "mechanics/mesh/reference.hpp"
#include "support/block.hpp"

namespace langer::example {

// one cell with the corners of the reference cube moved by `map`
inline Mesh one_cell(auto map) {
  Mesh mesh;
  for (int a = 0; a < 8; ++a) {
    mesh.X.push_back(map(Vec3(Hex8::corner[a][0], Hex8::corner[a][1], Hex8::corner[a][2])));
    mesh.connectivity.push_back(a);
  }
  mesh.bodies = {"skin"}, mesh.body = {0}, mesh.frames = {Mat3::Identity()};
  return mesh;
}

inline Mat3 turn(double degrees, const Vec3& axis) {
  return Eigen::AngleAxisd(degrees * 3.14159265358979323846 / 180, axis.normalized())
      .toRotationMatrix();
}

}  // namespace langer::example
