#include "export/fibre_frame.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace langer {

namespace {

// A vector across e1: of the first family that is not parallel to e1, otherwise of the axis that is
// most perpendicular to it.
Vec3 across(const Vec3& e1, const std::vector<Vec3>& fibres) {
  for (const Vec3& a : fibres) {
    const Vec3 rest = a - a.dot(e1) * e1;
    if (rest.norm() > 1e-6) return rest;
  }
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(e1[k]) < std::abs(e1[axis])) axis = k;
  return Vec3::Unit(axis) - e1[axis] * e1;
}

// Components that are rounding errors become 0.
double without_rounding(double x) {
  if (std::abs(x) < 1e-14) return 0;
  return x;
}

}  // namespace

// Programs that read the third axis as e1 x e2 get a right-handed frame.
FibreFrame fibre_frame(const std::vector<Vec3>& fibres) {
  FibreFrame frame;
  frame.e1 = fibres[0];
  frame.e2 = across(frame.e1, fibres).normalized();
  const Vec3 e3 = frame.e1.cross(frame.e2);
  for (const Vec3& a : fibres) {
    const Vec3 components(a.dot(frame.e1), a.dot(frame.e2), a.dot(e3));
    frame.in_frame.push_back(components.unaryExpr(&without_rounding));
  }
  return frame;
}

}  // namespace langer
