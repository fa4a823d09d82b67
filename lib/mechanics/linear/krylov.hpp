// Linear systems whose matrix is known by its products alone.
#pragma once

#include <functional>

#include "core/tensor/types.hpp"

namespace langer {

using LinearMap = std::function<VecX(const VecX&)>;

// x of A x = b by GMRES from b itself: for an A near the identity. Ends where |b - A x| <=
// tolerance |b|, or after `most` products.
VecX solve_near_identity(const LinearMap& A, const VecX& b, double tolerance, int most);

}  // namespace langer
