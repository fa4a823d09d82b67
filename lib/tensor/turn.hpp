// Rotation about an axis.
#pragma once

#include <cmath>

#include "tensor/types.hpp"

namespace langer {

// a straight line in space; for rotations positive angles go by the right hand
struct Line {
  Vec3 point = Vec3::Zero();   // [mm]
  Vec3 along = Vec3::UnitY();  // of length 1
};

inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// (R - 1) q, R the rotation about the unit vector a, to the last digit for small angles [rad] too:
//   q_across = q - (q.a) a,   1 - cos = 2 sin^2(angle / 2)
inline Vec3 turned_by(const Vec3& a, double angle, const Vec3& q) {
  const double half = std::sin(0.5 * angle);
  return std::sin(angle) * cross(a, q) - 2 * half * half * (q - q.dot(a) * a);
}

inline Mat3 rotation(const Vec3& a, double angle) {
  Mat3 R;
  for (int k = 0; k < 3; ++k) R.col(k) = Vec3::Unit(k) + turned_by(a, angle, Vec3::Unit(k));
  return R;
}

// A place as its distance from the line and along it.
struct AboutLine {
  double along = 0, rho = 0;    // [mm]
  Vec3 outward = Vec3::Zero();  // across the line, of length 1; 0 on it
};
inline AboutLine about(const Line& line, const Vec3& x) {
  const Vec3 q = x - line.point;
  AboutLine at{q.dot(line.along), 0, Vec3::Zero()};
  const Vec3 across = q - at.along * line.along;
  at.rho = across.norm();
  if (at.rho > 0) at.outward = across / at.rho;
  return at;
}

}  // namespace langer
