// Balance of the free unknowns with the contact reactions fixed: f(x) = 0 as libraries of nonlinear
// solvers take it.
#pragma once

#include <functional>
#include <vector>

#include "core/tensor/types.hpp"

namespace langer {

struct FreeBalance {
  std::vector<int> free;                                 // index in x of each free unknown
  std::function<bool(const VecX& x, VecX& f)> residual;  // false where x is not admissible
  std::function<bool(const VecX& x)>
      tangent;  // assembles and factorizes at x; false where it is singular
  // with that tangent; fresh: it is that of the x of the last residual()
  std::function<VecX(const VecX& rhs, bool fresh)> solve;
};

}  // namespace langer
