// Linear least squares in a box [SP95]:  min |A x - b|^2,  lower <= x <= upper.
// An active set method: the answer is exact, and what rests on a bound is exactly there.
//   A  (m, n) of full column rank;  lower <= upper, infinite bounds allowed
#pragma once

#include "core/tensor/types.hpp"

namespace langer {

VecX bounded_linear(const MatX& A, const VecX& b, const VecX& lower, const VecX& upper);

}  // namespace langer
