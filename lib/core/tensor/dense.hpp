// Decompositions of dense matrices. Eigen's, compiled in one place: where they are used each takes
// the compiler seconds.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>

#include "core/tensor/types.hpp"

namespace langer {

// P L U of a square matrix
class Lu {
 public:
  Lu() = default;
  explicit Lu(const MatX& A) { compute(A); }

  void compute(const MatX& A);
  VecX solve(const VecX& b) const;  // not finite where A is singular
  MatX solve_columns(const MatX& B) const;
  MatX solve_transposed(const MatX& B) const;
  double rcond() const;  // reciprocal condition number; a pivot may be zero

 private:
  Eigen::PartialPivLU<MatX> lu_;
};

// Householder's Q R; A may have more rows than columns
class Qr {
 public:
  explicit Qr(const MatX& A);

  MatX R() const;  // (min(rows, columns), columns), upper triangular
  VecX Q_transposed_times(const VecX& b) const;

 private:
  Eigen::HouseholderQR<MatX> qr_;
};

// min |A x - b|, columns pivoted
class PivotedQr {
 public:
  explicit PivotedQr(const MatX& A);

  Eigen::Index rank() const;
  VecX solve(const VecX& b) const;
  MatX solve_columns(const MatX& B) const;

 private:
  Eigen::ColPivHouseholderQR<MatX> qr_;
};

// min |A x - b|, and of those the smallest x: A may lack rank
class LeastNorm {
 public:
  LeastNorm() = default;
  explicit LeastNorm(const MatX& A) { compute(A); }
  LeastNorm(const MatX& A, double threshold);  // pivots below it, of the largest one, are none

  void compute(const MatX& A);
  VecX solve(const VecX& b) const;
  MatX solve_columns(const MatX& B) const;

 private:
  Eigen::CompleteOrthogonalDecomposition<MatX> all_;
};

// Cholesky's A = L L^T of a symmetric positive definite matrix; reads the lower triangle alone
class Cholesky {
 public:
  explicit Cholesky(const MatX& A);

  bool positive_definite() const;  // where false the others have no meaning
  MatX L() const;
  double log_determinant() const;
  VecX solve(const VecX& b) const;
  MatX solve_columns(const MatX& B) const;
  MatX inverse() const;

 private:
  Eigen::LLT<MatX> llt_;
};

// x of A x = b by L D L^T, A symmetric and definite or nearly so
VecX solve_symmetric(const MatX& A, const VecX& b);

// A = U diag(values) V^T, n = min(rows, columns)
struct Svd {
  MatX U;       // (rows, n)
  VecX values;  // (n), descending
  MatX V;       // (columns, n)
};
Svd svd(const MatX& A);

// A = vectors diag(values) vectors^T of a symmetric matrix
struct SymmetricEigen {
  VecX values;   // (n), ascending
  MatX vectors;  // (n, n)
};
SymmetricEigen symmetric_eigen(const MatX& A);
VecX symmetric_eigenvalues(const MatX& A);  // (n), ascending

// C = R R^T of a covariance, by eigenvalues in units of its diagonal; those that rounding makes
// negative are 0
MatX covariance_root(const MatX& C);

}  // namespace langer
