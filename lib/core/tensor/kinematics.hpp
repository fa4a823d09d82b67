// Motion of a point: x = X + u.                                                        [A23] eqs
// 3-5, 9
//   H = du/dX (3,3)   F = I + H   C = F^T F   E = (C - I)/2   J = det F
// Near incompressibility the pressure is (2/d)(J - 1) with 2/d up to 2e6 MPa, so J - 1 and E are
// formed from H: det F - 1 would lose the digits that decide the pressure.
#pragma once

#include "core/tensor/types.hpp"

namespace langer {

inline Mat3 deformation_gradient(const Mat3& H) { return Mat3::Identity() + H; }
inline Mat3 right_cauchy_green(const Mat3& F) { return F.transpose() * F; }
inline Mat3 green_lagrange(const Mat3& H) { return 0.5 * (H + H.transpose() + H.transpose() * H); }

// det(I + A) - 1 = tr A + i2(A) + det A, any A (3,3)
inline double determinant_minus_1(const Mat3& A) {
  const double i2 = A(0, 0) * A(1, 1) - A(0, 1) * A(1, 0) + A(1, 1) * A(2, 2) - A(1, 2) * A(2, 1) +
                    A(2, 2) * A(0, 0) - A(2, 0) * A(0, 2);
  const double i3 = A(0, 0) * (A(1, 1) * A(2, 2) - A(1, 2) * A(2, 1)) +
                    A(0, 1) * (A(1, 2) * A(2, 0) - A(1, 0) * A(2, 2)) +
                    A(0, 2) * (A(1, 0) * A(2, 1) - A(1, 1) * A(2, 0));
  return (A(0, 0) + A(1, 1) + A(2, 2)) + i2 + i3;
}

// J - 1 of a displacement gradient
inline double volume_change(const Mat3& H) { return determinant_minus_1(H); }

}  // namespace langer
