// The softest movements of a body at an equilibrium: eigenvectors of its constrained tangent,
//   K phi = lambda phi,    those with the smallest |lambda|
// by subspace iteration: a few vectors are multiplied by K^-1 again and again, and K is projected
// on the space that they span. A small |lambda| is a large eigenvalue of K^-1, so that one of
// nearly 0, as near a critical point, is found in a few iterations.
#pragma once

#include <vector>

#include "core/tensor/types.hpp"
#include "mechanics/assembly/pattern.hpp"

namespace langer {

struct SoftMode {
  double eigenvalue = 0;  // [N/mm]
  VecX shape;             // on the rows of K, norm 1
};

// The n modes of the tangent with the smallest magnitude of the eigenvalue, that first. held:
// directions that must not move (forces of unit pressure where a volume is given). Empty where K is
// singular to the last digit.
std::vector<SoftMode> softest_modes(const Pattern& pattern, const std::vector<double>& K, int n,
                                    const std::vector<VecX>& held, int threads);

}  // namespace langer
