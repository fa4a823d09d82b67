// Principal values and directions of symmetric tensors. Eigen's iterative solver, compiled in one
// place: where it is used it takes the compiler seconds.
#pragma once

#include "core/tensor/types.hpp"

namespace langer {

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

// A = directions diag(values) directions^T
struct Principal {
  Vec3 values;      // ascending
  Mat3 directions;  // unit columns
};
struct PlanePrincipal {
  Vec2 values;      // ascending
  Mat2 directions;  // unit columns
};

// They read the lower triangle alone.
Principal principal(const Mat3& A);
PlanePrincipal principal(const Mat2& A);
Vec3 principal_values(const Mat3& A);  // ascending
Vec2 principal_values(const Mat2& A);  // ascending

}  // namespace langer
