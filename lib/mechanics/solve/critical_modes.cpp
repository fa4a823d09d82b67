#include "mechanics/solve/critical_modes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "core/tensor/dense.hpp"
#include "mechanics/linear/linear.hpp"

namespace langer {

namespace {

// Columns with the same span that are orthonormal, by Gram and Schmidt, twice.
void orthonormalize(MatX& X) {
  for (int pass = 0; pass < 2; ++pass) {
    for (Eigen::Index c = 0; c < X.cols(); ++c) {
      for (Eigen::Index k = 0; k < c; ++k) X.col(c) -= X.col(k).dot(X.col(c)) * X.col(k);
      X.col(c).normalize();
    }
  }
}

}  // namespace

std::vector<SoftMode> softest_modes(const Pattern& pattern, const std::vector<double>& K, int n,
                                    const std::vector<VecX>& held, int threads) {
  LinearSolver solver(pattern, {}, threads);
  if (!solver.factorize(K) && !solver.factorize_indefinite(K)) return {};
  const Eigen::Index rows = pattern.n;
  const Eigen::Index size = std::min<Eigen::Index>(n + 3, rows - Eigen::Index(held.size()));
  if (size < 1) return {};

  // K^-1 on the movements that leave `held` in place: x - B C^-1 F^T x with B = K^-1 F, C = F^T B
  const auto m = static_cast<Eigen::Index>(held.size());
  MatX F(rows, m);
  MatX B(rows, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    F.col(j) = held[static_cast<std::size_t>(j)];
    B.col(j) = solver.solve(F.col(j));
  }
  Lu C;
  if (m > 0) C.compute(F.transpose() * B);
  const auto inverse = [&](const VecX& x) -> VecX {
    VecX y = solver.solve(x);
    if (m > 0) y -= B * C.solve(F.transpose() * y);
    return y;
  };

  std::mt19937 random(1);
  std::uniform_real_distribution<double> entry(-1, 1);
  MatX X(rows, size);
  for (Eigen::Index c = 0; c < size; ++c)
    for (Eigen::Index r = 0; r < rows; ++r) X(r, c) = entry(random);
  for (Eigen::Index c = 0; c < size; ++c) X.col(c) = inverse(X.col(c));
  orthonormalize(X);

  VecX before = VecX::Zero(size);
  VecX of_inverse(size);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(size));
  for (int iteration = 0; iteration < 100; ++iteration) {
    MatX Y(rows, size);
    for (Eigen::Index c = 0; c < size; ++c) Y.col(c) = inverse(X.col(c));
    if (!Y.allFinite()) return {};
    MatX T = X.transpose() * Y;
    T = (0.5 * (T + T.transpose())).eval();
    const SymmetricEigen small = symmetric_eigen(T);
    of_inverse = small.values;
    std::iota(order.begin(), order.end(), Eigen::Index(0));
    std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
      return std::abs(of_inverse[a]) > std::abs(of_inverse[b]);
    });
    MatX next(rows, size);
    VecX values(size);
    for (Eigen::Index c = 0; c < size; ++c) {
      const Eigen::Index from = order[static_cast<std::size_t>(c)];
      next.col(c) = Y * small.vectors.col(from);
      values[c] = of_inverse[from];
    }
    orthonormalize(next);
    X = next;
    double change = 0;
    for (Eigen::Index c = 0; c < std::min<Eigen::Index>(n, size); ++c)
      change = std::max(change, std::abs(values[c] - before[c]) / std::abs(values[c]));
    before = values;
    if (change < 1e-10 && iteration > 2) break;
  }
  std::vector<SoftMode> modes;
  for (Eigen::Index c = 0; c < std::min<Eigen::Index>(n, size); ++c)
    modes.push_back({1 / before[c], X.col(c)});
  return modes;
}

}  // namespace langer
