// Direct solution of A x = b for a complex symmetric A, by UMFPACK: a body that oscillates at one
// frequency. A is not Hermitian, so Cholesky's method does not apply.
#pragma once

#include <Eigen/SparseCore>
#include <complex>
#include <memory>

#include "core/tensor/types.hpp"

namespace langer {

using Complex = std::complex<double>;
using VecXc = Eigen::VectorXcd;
using SparseXc = Eigen::SparseMatrix<Complex>;  // both triangles

class ComplexSolver {
 public:
  ComplexSolver();
  ~ComplexSolver();

  // Factorizes A (n, n); the pattern is analysed again only where it differs from that of the last
  // matrix. False where A is singular.
  bool factorize(const SparseXc& A);
  VecXc solve(const VecXc& b) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace langer
