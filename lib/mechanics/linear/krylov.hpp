// GMRES for linear systems whose matrix is known only by its products with vectors.
//
// The method looks for x in the space of b, A b, A^2 b, ..., one product a time, and takes the
// vector with the smallest residual. It is quick if A is close to the identity, as K_0^-1 K is for
// a factor K_0 of most of K: pressures on a free rim, friction.
#pragma once

#include <functional>

#include "core/tensor/types.hpp"

namespace langer {

using LinearMap = std::function<VecX(const VecX&)>;

// Solves A x = b by GMRES, for an A close to the identity: it starts from x = b. Ends if |b - A x|
// <= tolerance |b|, or after `most` products. left: receives |b - A x| / |b|
VecX solve_near_identity(const LinearMap& A, const VecX& b, double tolerance, int most,
                         double* left = nullptr);

}  // namespace langer
