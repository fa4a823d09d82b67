#include "mechanics/solve/jump_axes.hpp"

#include <Eigen/LU>

namespace langer {

namespace {

// part of the normal that the free directions have to reach
constexpr double least_normal = 0.3;

}  // namespace

void JumpAxes::turn_to(const Mat3& frame) {
  Mat3 in_free = Mat3::Zero();  // (n, 3): rows of the frame that are free
  for (int i = 0; i < n; ++i) in_free.row(i) = frame.row(axis[i]);
  const double size = in_free.col(0).norm();
  moves = size > least_normal;
  Q.setIdentity();
  if (!moves) return;
  if (n == 3) {
    Q = frame;
  } else {
    // Where some directions are held, n has to do with what is left of it in the others.
    Q.col(0) = in_free.col(0) / size;
    if (n == 2) Q.col(1) = Vec3(-Q(1, 0), Q(0, 0), 0);
  }
  const Mat3 moved = in_free.transpose() * Q;  // (3, n)
  normal = moved(0, 0);
  lean = moved.block<2, 1>(1, 0);
  along.setZero();
  sticks.setZero();
  for (int j = 1; j < n; ++j) {
    along.col(j - 1) = moved.block<2, 1>(1, j);
    // an axis that moves nothing along the surface knows no slip
    if (const double length = along.col(j - 1).norm(); length > 1e-6)
      sticks.col(j - 1) = along.col(j - 1) / length;
  }
}

Vec3 JumpAxes::by_axes(const Vec3& x) const {
  Vec3 z = Vec3::Zero();
  z[0] = x[0] / normal;
  const Eigen::Vector2d rest = x.tail<2>() - lean * z[0];
  if (n == 3) z.tail<2>() = along.inverse() * rest;
  if (n == 2 && !sticks.isZero(0)) z[1] = sticks.col(0).dot(rest) / along.col(0).norm();
  return z;
}

Vec3 JumpAxes::row_of(const Vec3& multiplier) const {
  const Eigen::Vector2d r = sticks * multiplier.tail<2>();
  Vec3 row;
  row << normal * multiplier[0] + lean.dot(r), along.transpose() * r;
  return row;
}

Vec3 JumpAxes::multiplier_of(const Vec3& row) const {
  Vec3 out = Vec3::Zero();
  if (n == 3) out.tail<2>() = (along.transpose() * sticks).inverse() * row.tail<2>();
  if (n == 2 && !sticks.isZero(0)) out[1] = row[1] / along.col(0).norm();
  out[0] = (row[0] - lean.dot(sticks * out.tail<2>())) / normal;
  return out;
}

}  // namespace langer
