// Newton's step of an energy of two stretches that need not be convex.
#pragma once

#include "core/tensor/principal.hpp"

namespace langer {

// -|H|^-1 g with the absolute values of the eigenvalues of H: it leads downhill also where the
// energy is not convex. Each component along an eigenvector is at most 1/5.
Vec2 downhill_step(const Vec2& g, const Mat2& H);

}  // namespace langer
