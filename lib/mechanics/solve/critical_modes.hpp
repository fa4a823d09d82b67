// The softest movements of a body at an equilibrium: eigenvectors of its constrained tangent K with
// the eigenvalues closest to 0, by subspace iteration on K^-1. Near a critical point one of them is
// nearly 0, and a few iterations suffice.
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
