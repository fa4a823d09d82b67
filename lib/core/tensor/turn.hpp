// Rotation about an axis.
#pragma once

#include "core/tensor/types.hpp"

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
Vec3 turned_by(const Vec3& a, double angle, const Vec3& q);

Mat3 rotation(const Vec3& a, double angle);

// A place as its distance from the line and along it.
struct AboutLine {
  double along = 0, rho = 0;    // [mm]
  Vec3 outward = Vec3::Zero();  // across the line, of length 1; 0 on it
};
AboutLine about(const Line& line, const Vec3& x);

}  // namespace langer
