// The lowest eigenvalues of K x = lambda M x, for symmetric K and positive definite M.
//
// A body has as many eigenvalues as unknowns, and only the lowest matter. (K - sigma M)^-1 M has
// the same eigenvectors, and its largest eigenvalues 1 / (lambda - sigma) belong to the lowest
// lambda above the shift sigma. Multiplying a few vectors by it again and again makes a small
// space (block Krylov) that contains the wanted vectors more and more exactly; within that space
// the problem is a small dense one.
//                                                                                        [GLS94]
// A block instead of a single vector finds eigenvalues that are several times there, as those of a
// sphere or of a body with symmetry always are. Sylvester's law of inertia then proves that none is
// missing: K - s M has as many negative pivots as there are eigenvalues below s.
#pragma once

#include <Eigen/SparseCore>

#include "core/tensor/types.hpp"

namespace langer {

using SparseX = Eigen::SparseMatrix<double>;  // both triangles of symmetric matrices

struct Eigenpairs {
  VecX values;   // ascending
  MatX vectors;  // columns, x' M x = 1
  // The number of eigenvalues below the last one but for its multiples was counted, and agrees.
  bool counted = false;
};

// count: at most the number of rows. Throws std::runtime_error where the iteration does not end,
// or M is not positive definite.
Eigenpairs lowest_eigenpairs(const SparseX& K, const SparseX& M, int count, int threads = 1);

}  // namespace langer
