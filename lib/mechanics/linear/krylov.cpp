#include "mechanics/linear/krylov.hpp"

#include <Eigen/Sparse>
#include <unsupported/Eigen/IterativeSolvers>

namespace langer {

namespace {
class ProductMatrix;
}

}  // namespace langer

// Eigen needs these traits of a class that acts as a matrix without storing one.
template <>
struct Eigen::internal::traits<langer::ProductMatrix>
    : Eigen::internal::traits<Eigen::SparseMatrix<double>> {};

namespace langer {

namespace {

class ProductMatrix : public Eigen::EigenBase<ProductMatrix> {
 public:
  using Scalar = double;
  using RealScalar = double;
  using StorageIndex = int;
  enum {
    ColsAtCompileTime = Eigen::Dynamic,
    MaxColsAtCompileTime = Eigen::Dynamic,
    IsRowMajor = false
  };

  ProductMatrix(const LinearMap& map, Eigen::Index n) : map_(&map), n_(n) {}
  Eigen::Index rows() const { return n_; }
  Eigen::Index cols() const { return n_; }
  VecX times(const VecX& x) const { return (*map_)(x); }
  template <typename Right>
  Eigen::Product<ProductMatrix, Right, Eigen::AliasFreeProduct> operator*(
      const Eigen::MatrixBase<Right>& x) const {
    return {*this, x.derived()};
  }

 private:
  const LinearMap* map_;
  Eigen::Index n_;
};

}  // namespace

}  // namespace langer

template <typename Right>
struct Eigen::internal::generic_product_impl<langer::ProductMatrix, Right, Eigen::SparseShape,
                                             Eigen::DenseShape, Eigen::GemvProduct>
    : Eigen::internal::generic_product_impl_base<
          langer::ProductMatrix, Right,
          Eigen::internal::generic_product_impl<langer::ProductMatrix, Right>> {
  template <typename Out>
  static void scaleAndAddTo(Out& out, const langer::ProductMatrix& A, const Right& x,
                            double factor) {
    out += factor * A.times(x);
  }
};

namespace langer {

VecX solve_near_identity(const LinearMap& A, const VecX& b, double tolerance, int most,
                         double* left) {
  const ProductMatrix matrix(A, b.size());
  Eigen::GMRES<ProductMatrix, Eigen::IdentityPreconditioner> gmres;
  gmres.setTolerance(tolerance).setMaxIterations(most).set_restart(most);
  gmres.compute(matrix);
  const VecX x = gmres.solveWithGuess(b, b);
  if (left) *left = gmres.error();
  return x;
}

}  // namespace langer
