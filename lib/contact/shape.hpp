// What contact needs to know of a rigid shape at a point x of space.
//   gap     signed distance, > 0 outside [mm]
//   normal  gradient of the gap: from the shape to the body
//   curvature  dn/dx (3,3), symmetric, curvature n = 0: curvature of the surface of constant gap through x [1/mm]
#pragma once

#include "tensor/types.hpp"

namespace langer {

struct ShapePoint {
  double gap = 0;
  Vec3 normal = Vec3::UnitY();
  Mat3 curvature = Mat3::Zero();
};

inline Mat3 tangent_projection(const Vec3& n) { return Mat3::Identity() - n * n.transpose(); }
inline Vec3 vec(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

}  // namespace langer
