#include "identification/fit/bounded_linear.hpp"

#include <vector>

#include "core/tensor/dense.hpp"

namespace langer {

namespace {

// Whether a variable is free or held at one of its bounds: the active set.
enum class At { free, lower, upper };

// The least squares solution in the free variables, while the others stay at their bounds.
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
  // Start at the point of the box closest to zero.
  VecX x = VecX::Zero(n).cwiseMax(lower).cwiseMin(upper);
  std::vector<At> at(static_cast<std::size_t>(n), At::free);
  const auto state = [&](Eigen::Index i) -> At& {
    return at[static_cast<std::size_t>(i)];
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    if (x[i] == lower[i]) state(i) = At::lower;
    if (x[i] == upper[i]) state(i) = At::upper;
  }

  // Each round lowers the cost or frees one variable, so the method visits finitely many active
  // sets. The limit guards against rounding only.
  for (Eigen::Index round = 0; round < 20 * (n + 1); ++round) {
    // Go to the solution of the free variables, or up to the first bound on the way. A variable
    // that reaches its bound is held there.
    for (Eigen::Index pass = 0; pass <= n; ++pass) {
      const VecX z = with_free_solved(A, b, x, at);
      double t = 1;
      Eigen::Index hit = -1;
      for (Eigen::Index i = 0; i < n; ++i) {
        if (state(i) != At::free || (z[i] >= lower[i] && z[i] <= upper[i])) continue;
        // the part of the way to z at which the variable reaches its bound
        double bound = upper[i];
        if (z[i] < lower[i]) bound = lower[i];
        const double reach = (bound - x[i]) / (z[i] - x[i]);
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
      if (z[hit] < lower[hit]) {
        state(hit) = At::lower;
        x[hit] = lower[hit];
      } else {
        state(hit) = At::upper;
        x[hit] = upper[hit];
      }
      x = x.cwiseMax(lower).cwiseMin(upper);
    }
    // Free the held variable with the steepest descent into the box. If there is none, x satisfies
    // the Kuhn-Tucker conditions.
    const VecX residual = A * x - b;
    const VecX slope = A.transpose() * residual;
    Eigen::Index leaves = -1;
    double strongest = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (state(i) == At::free || lower[i] == upper[i]) continue;
      const double size = A.col(i).norm() * residual.norm();
      // the decrease of the cost along the way into the box, as a cosine
      double wish = slope[i];
      if (state(i) == At::lower) wish = -slope[i];
      if (size > 0) wish /= size;
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
