#include "mechanics/linear/krylov.hpp"

#include <Eigen/Sparse>
#include <unsupported/Eigen/IterativeSolvers>

namespace langer {

namespace {
class ByProducts;
}

}  // namespace langer

// what Eigen asks of a matrix that is none
template <>
struct Eigen::internal::traits<langer::ByProducts>
    : Eigen::internal::traits<Eigen::SparseMatrix<double>> {};

namespace langer {

namespace {

class ByProducts : public Eigen::EigenBase<ByProducts> {
 public:
  using Scalar = double;
  using RealScalar = double;
  using StorageIndex = int;
  enum {
    ColsAtCompileTime = Eigen::Dynamic,
    MaxColsAtCompileTime = Eigen::Dynamic,
    IsRowMajor = false
  };

  ByProducts(const LinearMap& map, Eigen::Index n) : map_(&map), n_(n) {}
  Eigen::Index rows() const { return n_; }
  Eigen::Index cols() const { return n_; }
  VecX times(const VecX& x) const { return (*map_)(x); }
  template <typename Right>
  Eigen::Product<ByProducts, Right, Eigen::AliasFreeProduct> operator*(
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
struct Eigen::internal::generic_product_impl<langer::ByProducts, Right, Eigen::SparseShape,
                                             Eigen::DenseShape, Eigen::GemvProduct>
    : Eigen::internal::generic_product_impl_base<
          langer::ByProducts, Right,
          Eigen::internal::generic_product_impl<langer::ByProducts, Right>> {
  template <typename Out>
  static void scaleAndAddTo(Out& out, const langer::ByProducts& A, const Right& x, double factor) {
    out += factor * A.times(x);
  }
};

namespace langer {

VecX solve_near_identity(const LinearMap& A, const VecX& b, double tolerance, int most) {
  const ByProducts matrix(A, b.size());
  Eigen::GMRES<ByProducts, Eigen::IdentityPreconditioner> gmres;
  gmres.setTolerance(tolerance).setMaxIterations(most).set_restart(most);
  gmres.compute(matrix);
  return gmres.solveWithGuess(b, b);
}

}  // namespace langer
