// Linear systems whose matrix is given by its products with vectors only.
#pragma once

#include <functional>

#include "core/tensor/types.hpp"

namespace langer {

using LinearMap = std::function<VecX(const VecX&)>;

// Solves A x = b by GMRES, for an A close to the identity: it starts from x = b. Ends if |b - A x|
// <= tolerance |b|, or after `most` products.
VecX solve_near_identity(const LinearMap& A, const VecX& b, double tolerance, int most);

}  // namespace langer
