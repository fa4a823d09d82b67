#include "identification/fit/bounded_linear.hpp"

#include <vector>

#include "core/tensor/dense.hpp"

namespace langer {

namespace {

enum class At { free, lower, upper };

// the unconstrained answer in the free variables, the others held
VecX with_free_solved(const MatX& A, const VecX& b, const VecX& x, const std::vector<At>& at) {
  std::vector<Eigen::Index> free;
  VecX rest = b;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (at[static_cast<std::size_t>(i)] == At::free)
      free.push_back(i);
    else
      rest -= A.col(i) * x[i];
  VecX z = x;
  if (!free.empty()) z(free) = PivotedQr(A(Eigen::all, free)).solve(rest);
  return z;
}

}  // namespace

VecX bounded_linear(const MatX& A, const VecX& b, const VecX& lower, const VecX& upper) {
  const Eigen::Index n = A.cols();
  VecX x = VecX::Zero(n).cwiseMax(lower).cwiseMin(upper);
  std::vector<At> at(static_cast<std::size_t>(n), At::free);
  const auto state = [&](Eigen::Index i) -> At& {
    return at[static_cast<std::size_t>(i)];
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    if (x[i] == lower[i]) state(i) = At::lower;
    if (x[i] == upper[i]) state(i) = At::upper;
  }

  // each round lowers the cost or frees one variable: the number of sets is finite, the limit
  // guards against rounding only
  for (Eigen::Index round = 0; round < 20 * (n + 1); ++round) {
    // towards the answer of the free variables as far as the box allows
    for (Eigen::Index pass = 0; pass <= n; ++pass) {
      const VecX z = with_free_solved(A, b, x, at);
      double t = 1;
      Eigen::Index hit = -1;
      for (Eigen::Index i = 0; i < n; ++i) {
        if (state(i) != At::free || (z[i] >= lower[i] && z[i] <= upper[i])) continue;
        const double reach = ((z[i] < lower[i] ? lower[i] : upper[i]) - x[i]) / (z[i] - x[i]);
        if (reach < t || hit < 0) {
          t = std::min(t, reach);
          hit = i;
        }
      }
      if (hit < 0) {
        x = z;
        break;
      }
      x += t * (z - x);
      state(hit) = z[hit] < lower[hit] ? At::lower : At::upper;
      x[hit] = z[hit] < lower[hit] ? lower[hit] : upper[hit];
      x = x.cwiseMax(lower).cwiseMin(upper);
    }
    // a held variable that wants to leave its bound
    const VecX residual = A * x - b;
    const VecX slope = A.transpose() * residual;
    Eigen::Index leaves = -1;
    double strongest = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (state(i) == At::free || lower[i] == upper[i]) continue;
      const double size = A.col(i).norm() * residual.norm();
      const double wish = (state(i) == At::lower ? -slope[i] : slope[i]) / (size > 0 ? size : 1);
      if (wish > 1e-13 && wish > strongest) {
        strongest = wish;
        leaves = i;
      }
    }
    if (leaves < 0) return x;
    state(leaves) = At::free;
  }
  return x;
}

}  // namespace langer
