#include "export/fibre_frame.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace langer {

FibreFrame fibre_frame(const std::vector<Vec3>& fibres) {
  FibreFrame frame;
  frame.e1 = fibres[0];
  Vec3 other = Vec3::Zero();
  for (const Vec3& a : fibres)
    if (const Vec3 rest = a - a.dot(frame.e1) * frame.e1; rest.norm() > 1e-6 && other.isZero())
      other = rest;
  if (other.isZero()) {
    int axis = 0;
    for (int k = 1; k < 3; ++k)
      if (std::abs(frame.e1[k]) < std::abs(frame.e1[axis])) axis = k;
    other = Vec3::Unit(axis) - frame.e1[axis] * frame.e1;
  }
  frame.e2 = other.normalized();
  const Vec3 e3 = frame.e1.cross(frame.e2);
  const auto plain = [](double x) {
    return std::abs(x) < 1e-14 ? 0 : x;
  };
  for (const Vec3& a : fibres)
    frame.in_frame.push_back(Vec3(a.dot(frame.e1), a.dot(frame.e2), a.dot(e3)).unaryExpr(plain));
  return frame;
}

}  // namespace langer
