#include "core/tensor/principal.hpp"

#include <Eigen/Eigenvalues>

namespace langer {

Principal principal(const Mat3& A) {
  const Eigen::SelfAdjointEigenSolver<Mat3> of(A);
  return {of.eigenvalues(), of.eigenvectors()};
}

PlanePrincipal principal(const Mat2& A) {
  const Eigen::SelfAdjointEigenSolver<Mat2> of(A);
  return {of.eigenvalues(), of.eigenvectors()};
}

Vec3 principal_values(const Mat3& A) {
  return Eigen::SelfAdjointEigenSolver<Mat3>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

Vec2 principal_values(const Mat2& A) {
  return Eigen::SelfAdjointEigenSolver<Mat2>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace langer
