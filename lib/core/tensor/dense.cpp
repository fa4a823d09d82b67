#include "core/tensor/dense.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>

#include "core/base/traps.hpp"

namespace langer {

void Lu::compute(const MatX& A) { lu_.compute(A); }
VecX Lu::solve(const VecX& b) const {
  const NoTraps a_pivot_may_be_zero;
  return lu_.solve(b);
}
MatX Lu::solve_columns(const MatX& B) const { return lu_.solve(B); }
MatX Lu::solve_transposed(const MatX& B) const { return lu_.transpose().solve(B); }

double Lu::rcond() const {
  const NoTraps a_pivot_may_be_zero;
  return lu_.rcond();
}

Qr::Qr(const MatX& A) : qr_(A) {}
MatX Qr::R() const {
  const Eigen::Index n = std::min(qr_.rows(), qr_.cols());
  return qr_.matrixQR().topRows(n).triangularView<Eigen::Upper>();
}
VecX Qr::Q_transposed_times(const VecX& b) const { return qr_.householderQ().adjoint() * b; }

PivotedQr::PivotedQr(const MatX& A) : qr_(A) {}
Eigen::Index PivotedQr::rank() const { return qr_.rank(); }
VecX PivotedQr::solve(const VecX& b) const { return qr_.solve(b); }
MatX PivotedQr::solve_columns(const MatX& B) const { return qr_.solve(B); }

LeastNorm::LeastNorm(const MatX& A, double threshold) {
  all_.setThreshold(threshold);
  all_.compute(A);
}
void LeastNorm::compute(const MatX& A) { all_.compute(A); }
VecX LeastNorm::solve(const VecX& b) const { return all_.solve(b); }
MatX LeastNorm::solve_columns(const MatX& B) const { return all_.solve(B); }

Cholesky::Cholesky(const MatX& A) : llt_(A) {}
bool Cholesky::positive_definite() const { return llt_.info() == Eigen::Success; }
MatX Cholesky::L() const { return llt_.matrixL(); }
double Cholesky::log_determinant() const {
  return 2 * llt_.matrixLLT().diagonal().array().log().sum();
}
VecX Cholesky::solve(const VecX& b) const { return llt_.solve(b); }
MatX Cholesky::solve_columns(const MatX& B) const { return llt_.solve(B); }
MatX Cholesky::inverse() const { return llt_.solve(MatX::Identity(llt_.rows(), llt_.cols())); }

VecX solve_symmetric(const MatX& A, const VecX& b) { return A.ldlt().solve(b); }

Svd svd(const MatX& A) {
  const Eigen::JacobiSVD<MatX> of(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {of.matrixU(), of.singularValues(), of.matrixV()};
}

SymmetricEigen symmetric_eigen(const MatX& A) {
  const Eigen::SelfAdjointEigenSolver<MatX> of(A);
  return {of.eigenvalues(), of.eigenvectors()};
}
VecX symmetric_eigenvalues(const MatX& A) {
  return Eigen::SelfAdjointEigenSolver<MatX>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

MatX covariance_root(const MatX& C) {
  const VecX size = C.diagonal().cwiseSqrt();
  // numbers without a variance, such as those that all specimens share, have a row of zeros
  VecX inverse = VecX::Zero(size.size());
  for (Eigen::Index i = 0; i < size.size(); ++i)
    if (size[i] > 0) inverse[i] = 1 / size[i];
  const SymmetricEigen scaled = symmetric_eigen(inverse.asDiagonal() * C * inverse.asDiagonal());
  return size.asDiagonal() * scaled.vectors * scaled.values.cwiseMax(0).cwiseSqrt().asDiagonal();
}

}  // namespace langer
