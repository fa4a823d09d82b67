#include "solve/gmres.hpp"

#include <Eigen/Dense>
#include <vector>

namespace langer {

std::optional<VecX> gmres(const Product& A, const Product& preconditioner, const VecX& b, const GmresOptions& options) {
  const double size = b.norm();
  if (size == 0) return VecX(VecX::Zero(b.size()));
  if (!std::isfinite(size)) return std::nullopt;
  std::vector<VecX> basis{b / size}, moved;
  MatX H = MatX::Zero(options.largest + 1, options.largest);
  VecX y;
  double left = 1;
  for (int j = 0; j < options.largest && left > options.wanted; ++j) {
    moved.push_back(preconditioner(basis[static_cast<std::size_t>(j)]));
    VecX next = A(moved.back());
    for (int twice = 0; twice < 2; ++twice)  // once leaves what rounding makes of nearly parallel vectors
      for (int i = 0; i <= j; ++i) {
        const double h = basis[static_cast<std::size_t>(i)].dot(next);
        H(i, j) += h, next -= h * basis[static_cast<std::size_t>(i)];
      }
    H(j + 1, j) = next.norm();
    if (!std::isfinite(H(j + 1, j))) return std::nullopt;
    const MatX part = H.topLeftCorner(j + 2, j + 1);
    const VecX e = size * VecX::Unit(j + 2, 0);
    y = part.colPivHouseholderQr().solve(e);
    left = (e - part * y).norm() / size;
    if (H(j + 1, j) <= 1e-14 * size) break;
    basis.push_back(next / H(j + 1, j));
  }
  if (!(left <= options.enough)) return std::nullopt;
  VecX x = VecX::Zero(b.size());
  for (Eigen::Index j = 0; j < y.size(); ++j) x += y[j] * moved[static_cast<std::size_t>(j)];
  return x;
}

}  // namespace langer
