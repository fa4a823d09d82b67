#include "core/tensor/turn.hpp"

#include <cmath>

namespace langer {

Vec3 turned_by(const Vec3& a, double angle, const Vec3& q) {
  const double half = std::sin(0.5 * angle);
  return std::sin(angle) * cross(a, q) - 2 * half * half * (q - q.dot(a) * a);
}

Mat3 rotation(const Vec3& a, double angle) {
  Mat3 R;
  for (int k = 0; k < 3; ++k) R.col(k) = Vec3::Unit(k) + turned_by(a, angle, Vec3::Unit(k));
  return R;
}

AboutLine about(const Line& line, const Vec3& x) {
  const Vec3 q = x - line.point;
  AboutLine at{q.dot(line.along), 0, Vec3::Zero()};
  const Vec3 across = q - at.along * line.along;
  at.rho = across.norm();
  if (at.rho > 0) at.outward = across / at.rho;
  return at;
}

}  // namespace langer
