#include "mechanics/vibration/eigenpairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "core/tensor/dense.hpp"
#include "mechanics/linear/linear.hpp"

namespace langer {

namespace {

constexpr double tolerance = 1e-9;  // of a Ritz vector's residual, relative to its Ritz value
constexpr int first_block = 6;      // rigid movements of a free body are six
constexpr int largest_block = 24;

// The lower triangle as LinearSolver takes it.
struct Lower {
  Pattern pattern;
  std::vector<double> values;
};

Lower lower_triangle(const SparseX& A) {
  Lower out;
  out.pattern.n = static_cast<int>(A.rows());
  out.pattern.column_start.push_back(0);
  for (Eigen::Index c = 0; c < A.cols(); ++c) {
    for (SparseX::InnerIterator entry(A, c); entry; ++entry) {
      if (entry.row() < c) continue;
      out.pattern.row.push_back(static_cast<int>(entry.row()));
      out.values.push_back(entry.value());
    }
    out.pattern.column_start.push_back(out.pattern.nnz());
  }
  return out;
}

// K - s M in one pattern, whatever s. Entries that only one of them has are 0 in the other.
class Pencil {
 public:
  Pencil(const SparseX& K, const SparseX& M) {
    SparseX unit = K;
    for (Eigen::Index i = 0; i < unit.nonZeros(); ++i) unit.valuePtr()[i] = 0;
    K_ = K + 0.0 * M;
    M_ = unit + M;
  }
  Lower shifted(double s) const { return lower_triangle(K_ - s * M_); }

 private:
  SparseX K_, M_;
};

// Largest K_ii / M_ii: the size of the highest eigenvalues, and so of what rounding leaves of the
// lowest.
double largest_quotient(const SparseX& K, const SparseX& M) {
  const VecX k = K.diagonal();
  const VecX m = M.diagonal();
  double largest = 0;
  for (Eigen::Index i = 0; i < k.size(); ++i) {
    if (!(m[i] > 0)) throw std::runtime_error("a movement of the body has no mass");
    largest = std::max(largest, std::abs(k[i]) / m[i]);
  }
  return largest;
}

class BlockKrylov {
 public:
  BlockKrylov(const LinearSolver& solver, const SparseX& M, int block) : solver_(solver), M_(M) {
    const Eigen::Index n = M.rows();
    // The same vectors on every machine.
    std::mt19937_64 random(20240601);
    MatX start(n, std::min<Eigen::Index>(block, n));
    for (Eigen::Index c = 0; c < start.cols(); ++c) {
      for (Eigen::Index i = 0; i < n; ++i)
        start(i, c) = static_cast<double>(random() >> 11) / static_cast<double>(1ull << 53) - 0.5;
    }
    MatX unused;
    append(std::move(start), unused);
  }

  Eigen::Index size() const { return V_.cols(); }
  // Nothing more can be found: the space is mapped onto itself, and its Ritz pairs are exact.
  bool complete() const { return n_ritz() == size(); }

  // Multiplies the last block by (K - sigma M)^-1 M and solves the small problem.
  void step() {
    const Eigen::Index first = V_.cols() - last_;
    MatX W(V_.rows(), last_);
    for (Eigen::Index c = 0; c < last_; ++c) W.col(c) = solver_.solve(MV_.col(first + c));
    const Eigen::Index before = V_.cols();
    const Eigen::Index of_block = last_;
    MatX T = append(std::move(W), coupling_);
    T_.conservativeResize(before, before);
    T_.middleCols(first, of_block) = T;
    T_.middleRows(first, of_block) = T.transpose();
    small_ = symmetric_eigen(0.5 * (T_ + T_.transpose()));
    first_ = first;
    of_block_ = of_block;
  }

  // Of the small problem that step() solved, largest first.
  Eigen::Index n_ritz() const { return small_.values.size(); }
  double theta(Eigen::Index i) const { return small_.values[n_ritz() - 1 - i]; }
  double residual(Eigen::Index i) const {
    if (complete()) return 0;
    const VecX s = small_.vectors.col(n_ritz() - 1 - i).segment(first_, of_block_);
    return (coupling_ * s).norm();
  }
  VecX vector(Eigen::Index i) const {
    return V_.leftCols(n_ritz()) * small_.vectors.col(n_ritz() - 1 - i);
  }

 private:
  // Makes W orthonormal to what is there (in the product of M) and appends it. Returns the
  // coefficients on what was there; coupling: those on what is appended.
  MatX append(MatX W, MatX& coupling) {
    const Eigen::Index before = V_.cols();
    const Eigen::Index m = W.cols();
    MatX on_old = MatX::Zero(before, m);
    VecX size(m);
    for (Eigen::Index c = 0; c < m; ++c) size[c] = std::sqrt(W.col(c).dot(M_ * W.col(c)));
    if (before > 0) {
      for (int pass = 0; pass < 2; ++pass) {
        const MatX h = MV_.transpose() * W;
        W -= V_ * h;
        on_old += h;
      }
    }
    coupling = MatX::Zero(m, m);
    MatX Q(W.rows(), m);
    MatX MQ(W.rows(), m);
    Eigen::Index kept = 0;
    for (Eigen::Index c = 0; c < m; ++c) {
      VecX w = W.col(c);
      for (int pass = 0; pass < 2; ++pass) {
        // once more against all, as little may be left of w
        if (before > 0) w -= V_ * (MV_.transpose() * w);
        const VecX h = MQ.leftCols(kept).transpose() * w;
        w -= Q.leftCols(kept) * h;
        coupling.col(c).head(kept) += h;
      }
      const VecX Mw = M_ * w;
      const double length = std::sqrt(std::max(0.0, w.dot(Mw)));
      if (!(length > 1e-13 * size[c])) continue;
      Q.col(kept) = w / length;
      MQ.col(kept) = Mw / length;
      coupling(kept, c) = length;
      ++kept;
    }
    coupling.conservativeResize(kept, m);
    V_.conservativeResize(W.rows(), before + kept);
    MV_.conservativeResize(W.rows(), before + kept);
    V_.rightCols(kept) = Q.leftCols(kept);
    MV_.rightCols(kept) = MQ.leftCols(kept);
    last_ = kept;
    return on_old;
  }

  const LinearSolver& solver_;
  const SparseX& M_;
  MatX V_, MV_;  // orthonormal: V' M V = 1
  MatX T_;       // V' M (K - sigma M)^-1 M V
  MatX coupling_;
  Eigen::Index last_ = 0;  // columns of the last block
  Eigen::Index first_ = 0, of_block_ = 0;
  SymmetricEigen small_;
};

}  // namespace

Eigenpairs lowest_eigenpairs(const SparseX& K, const SparseX& M, int count, int threads) {
  const Eigen::Index n = K.rows();
  const Eigen::Index wanted = std::min<Eigen::Index>(count, n);
  Eigenpairs out;
  if (wanted == 0) return out;
  const double scale = std::max(largest_quotient(K, M), std::numeric_limits<double>::min());

  // The shift is below all eigenvalues. A stable body needs none, but a free one has eigenvalues 0.
  const Pencil pencil(K, M);
  LinearSolver solver(pencil.shifted(0).pattern, {}, threads);
  double sigma = -1e-10 * scale;
  while (!solver.factorize(pencil.shifted(sigma).values)) {
    sigma *= 30;
    if (-sigma > 1e6 * scale) throw std::runtime_error("the mass matrix is not positive definite");
  }

  for (int block = first_block;; block = std::min(2 * block, largest_block)) {
    BlockKrylov space(solver, M, block);
    // One more than is wanted shows where the wanted ones end.
    const Eigen::Index enough = std::min(wanted + 1, n);
    const Eigen::Index most = std::max<Eigen::Index>(300, 12 * wanted);
    while (true) {
      space.step();
      Eigen::Index good = 0;
      while (good < std::min(enough, space.n_ritz()) &&
             space.residual(good) <= tolerance * std::abs(space.theta(good)))
        ++good;
      if (good == enough || space.complete()) break;
      if (space.size() > most) throw std::runtime_error("eigenvalues were not found");
    }
    const Eigen::Index found = std::min(enough, space.n_ritz());
    VecX all(found);
    for (Eigen::Index i = 0; i < found; ++i) all[i] = sigma + 1 / space.theta(i);

    // Eigenvalues below a gap are counted.
    Eigen::Index below = std::min(wanted, found);
    const auto gap_after = [&](Eigen::Index k) {
      return all[k] - all[k - 1] > 1e-6 * std::max(std::abs(all[k]), 1e-9 * scale);
    };
    if (found == n) {
      out.counted = true;
    } else {
      while (below > 0 && (below >= found || !gap_after(below))) --below;
      if (below > 0) {
        const double between = 0.5 * (all[below - 1] + all[below]);
        out.counted = solver.negative_pivots(pencil.shifted(between).values) == below;
      }
    }
    if (!out.counted && below > 0 && block < largest_block) continue;
    out.values = all.head(std::min(wanted, found));
    out.vectors.resize(n, out.values.size());
    for (Eigen::Index i = 0; i < out.values.size(); ++i) out.vectors.col(i) = space.vector(i);
    return out;
  }
}

}  // namespace langer
