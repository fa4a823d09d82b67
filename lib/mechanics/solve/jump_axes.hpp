// Axes of a candidate between surfaces, along which its node can move: those of its frame
// (n, t1, t2), or where supports hold some directions, what these leave. A movement z along them is
//   along n  normal z_0,   along the surface  lean z_0 + along (z_1, z_2)
#pragma once

#include "core/tensor/types.hpp"
#include "mechanics/contact/coulomb_cone.hpp"

namespace langer {

struct JumpAxes {
  int n = 0;                  // free directions of the node
  int first = 0;              // row of the first; the others follow
  int axis[3] = {0, 0, 0};    // x, y or z of each
  Mat3 Q = Mat3::Identity();  // (n, n) columns: the axes in the free directions
  bool moves = false;         // the node, along its normal
  double normal = 0;
  Eigen::Vector2d lean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d along = Eigen::Matrix2d::Identity();  // (2, n - 1)
  Eigen::Matrix2d sticks = Eigen::Matrix2d::Zero();     // unit reactions that hold z_1, z_2

  // frame: columns n, t1, t2. n, first and axis are given.
  void turn_to(const Mat3& frame);
  // whether a candidate that does this is held along an axis
  bool hold(ContactStatus status, int own) const {
    if (!moves || own >= n || status == ContactStatus::open) return false;
    if (own == 0) return true;
    return status == ContactStatus::stick && !sticks.col(own - 1).isZero(0);
  }
  // the movement along the axes that does the local movement x; n > 0 and it moves
  Vec3 by_axes(const Vec3& x) const;
  // forces along the axes of multipliers: a reaction along n, and unit ones that hold z_1 and z_2
  Vec3 row_of(const Vec3& multiplier) const;
  Vec3 multiplier_of(const Vec3& row) const;  // the inverse
};

}  // namespace langer
