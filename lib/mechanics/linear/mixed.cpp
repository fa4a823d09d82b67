#include "mechanics/linear/mixed.hpp"

#include <algorithm>
#include <numeric>

#include "core/base/traps.hpp"

namespace langer {

namespace {

// For each row three times the number of its node among the free nodes, plus its axis: multigrid
// needs blocks of three rows, also for nodes that are held in some direction.
std::vector<int> block_rows(const std::vector<int>& dof_of_row) {
  std::vector<int> out;
  int nodes = 0, last = -1;
  for (int dof : dof_of_row) {
    if (dof / 3 != last) {
      last = dof / 3;
      ++nodes;
    }
    out.push_back(3 * (nodes - 1) + dof % 3);
  }
  return out;
}

int rows_of_nodes(const std::vector<int>& block_row) {
  if (block_row.empty()) return 0;
  return block_row.back() / 3 * 3 + 3;
}

// The rows of cells, renumbered to block rows.
std::vector<int> renumbered(std::vector<int> rows, const std::vector<int>& block_row) {
  for (int& row : rows)
    if (row >= 0) row = block_row[row];
  return rows;
}

}  // namespace

MixedSolver::MixedSolver(const Pattern& pattern, const std::vector<int>& dof_of_row,
                         std::vector<int> cell_rows, const petsc_module::Functions& module,
                         int threads, const Division* division)
    : pattern_(pattern),
      module_(module),
      ranks_(division ? division->ranks : nullptr),
      cell_rows_(std::move(cell_rows)),
      block_row_(block_rows(dof_of_row)),
      schur_(renumbered(cell_rows_, block_row_), rows_of_nodes(block_row_), division, threads),
      cycle_(module.multigrid(ranks_)) {
  const auto rows = static_cast<std::size_t>(rows_of_nodes(block_row_));
  A_.start.assign(rows + 1, 0);
  for (int column = 0; column < pattern.n; ++column)
    for (int at = pattern.column_start[column]; at < pattern.column_start[column + 1]; ++at) {
      ++A_.start[block_row_[column] + 1];
      if (pattern.row[at] != column) ++A_.start[block_row_[pattern.row[at]] + 1];
    }
  for (std::size_t row = 1; row < A_.start.size(); ++row)
    A_.start[row] = A_.start[row - 1] + std::max(A_.start[row], 1);
  if (!division) {
    own_.resize(static_cast<std::size_t>(n_cells()));
    std::iota(own_.begin(), own_.end(), 0);
    return;
  }
  own_ = division->cells();
  rank_of_node_.assign(rows / 3, -1);  // that of the first cell around it
  for (std::size_t k = 0; k < cell_rows_.size(); ++k)
    if (cell_rows_[k] >= 0)
      if (int& rank = rank_of_node_[block_row_[cell_rows_[k]] / 3]; rank < 0)
        rank = division->rank_of[k / per_cell];
  for (int& rank : rank_of_node_) rank = std::max(rank, 0);
}

VecX MixedSolver::gather(const std::vector<double>& b, const VecX& d) const {
  VecX out = VecX::Zero(n_cells());
  for (int e : own_)
    for (int k = 0; k < per_cell; ++k)
      if (const int row = cell_rows_[per_cell * e + k]; row >= 0)
        out[e] += b[per_cell * e + k] * d[row];
  if (ranks_) ranks_->sum(out.data(), static_cast<std::size_t>(out.size()));
  return out;
}

void MixedSolver::spread_own(const std::vector<double>& b, const VecX& q, VecX& f) const {
  for (int e : own_)
    for (int k = 0; k < per_cell; ++k)
      if (const int row = cell_rows_[per_cell * e + k]; row >= 0)
        f[row] += b[per_cell * e + k] * q[e];
}

void MixedSolver::spread(const std::vector<double>& b, const VecX& q, VecX& f) const {
  if (!ranks_) return spread_own(b, q, f);
  VecX all = VecX::Zero(f.size());
  spread_own(b, q, all);
  ranks_->sum(all.data(), static_cast<std::size_t>(all.size()));
  f += all;
}

VecX MixedSolver::diagonal_of(const std::vector<double>& A) const {
  VecX diagonal(pattern_.n);
  for (int row = 0; row < pattern_.n; ++row) diagonal[row] = A[pattern_.column_start[row]];
  if (ranks_) ranks_->sum(diagonal.data(), static_cast<std::size_t>(diagonal.size()));
  return diagonal;
}

// A as full rows, from its lower triangle by columns.
void MixedSolver::fill(const std::vector<double>& A, const VecX& diagonal) {
  const std::size_t rows = A_.start.size() - 1;
  if (A_.column.empty()) {
    A_.column.resize(A_.start.back());
    A_.value.resize(A_.start.back());
  }
  std::vector<int> to(A_.start.begin(), A_.start.end() - 1);
  const auto put = [&](int row, int column, double value) {
    A_.column[to[row]] = column;
    A_.value[to[row]++] = value;
  };
  // entries left of the diagonal first, so that the columns of each row ascend
  for (int column = 0; column < pattern_.n; ++column)
    for (int at = pattern_.column_start[column] + 1; at < pattern_.column_start[column + 1]; ++at)
      put(block_row_[pattern_.row[at]], block_row_[column], A[at]);
  double sum = 0;
  for (int column = 0; column < pattern_.n; ++column) {
    sum += diagonal[column];
    for (int at = pattern_.column_start[column]; at < pattern_.column_start[column + 1]; ++at)
      put(block_row_[column], block_row_[pattern_.row[at]], A[at]);
  }
  A_.inverse_diagonal.assign(rows, 0);
  // Held directions of nodes that are free in others get a diagonal entry, added by one rank.
  double held = 0;
  if (!ranks_ || ranks_->first()) held = sum / pattern_.n;
  for (std::size_t row = 0; row < rows; ++row)
    if (to[row] == A_.start[row]) put(static_cast<int>(row), static_cast<int>(row), held);
  for (int row = 0; row < pattern_.n; ++row)
    A_.inverse_diagonal[block_row_[row]] = 1 / diagonal[row];
}

VecX MixedSolver::times(const VecX& x) const {
  VecX y(x.size());
  if (ranks_) {
    cycle_->times(x.data(), y.data());
    return y;
  }
  for (Eigen::Index row = 0; row < x.size(); ++row) {
    double sum = 0;
    for (int at = A_.start[row]; at < A_.start[row + 1]; ++at)
      sum += A_.value[at] * x[A_.column[at]];
    y[row] = sum;
  }
  return y;
}

// Fixed rows have no part in the Schur complement.
bool MixedSolver::factorize_schur(const std::vector<double>& b, const std::vector<char>& fixed) {
  std::vector<double> scaled(b);  // B M^-1/2
  for (std::size_t k = 0; k < scaled.size(); ++k) {
    const int row = cell_rows_[k];
    if (row >= 0 && !fixed[row]) {
      scaled[k] *= std::sqrt(A_.inverse_diagonal[block_row_[row]]);
    } else {
      scaled[k] *= 0;
    }
  }
  return schur_.factorize(scaled, inverse_D_);
}

bool MixedSolver::precondition(const std::vector<double>& A, const std::vector<double>& b,
                               const VecX& D, const std::vector<char>& fixed, const MatX& rigid,
                               std::string& why) {
  preconditioned_ = false;
  const VecX diagonal = diagonal_of(A);
  if (!(diagonal.array() > 0).all()) {
    why = "the tangent has a diagonal entry that is not positive";
    return false;
  }
  fixed_ = fixed;
  fill(A, diagonal);
  inverse_D_ = D.cwiseInverse();
  if (!factorize_schur(b, fixed)) {
    why = "the Schur complement of the pressures is not positive definite";
    return false;
  }
  MatX modes = MatX::Zero(static_cast<Eigen::Index>(A_.start.size()) - 1, rigid.cols());
  for (int row = 0; row < pattern_.n; ++row) modes.row(block_row_[row]) = rigid.row(row);
  const NoTraps in_petsc;
  const petsc_module::Rows rows{static_cast<int>(A_.start.size()) - 1, A_.start.data(),
                                A_.column.data(), A_.value.data(), rank_of_node_.data()};
  preconditioned_ = cycle_->setup(rows, modes.data(), again_, why);
  again_ = preconditioned_;
  if (ranks_) {
    // PETSc has the whole rows of this rank
    A_.column = {};
    A_.value = {};
  }
  return preconditioned_;
}

// The preconditioner: pressures by the Schur complement, then displacements by a multigrid cycle
// with these pressures.
VecX MixedSolver::apply(const std::vector<double>& b, const VecX& r) const {
  const Eigen::Index rows = static_cast<Eigen::Index>(A_.start.size()) - 1;
  const Eigen::Index n = pattern_.n;
  VecX free = VecX::Zero(n);
  VecX block = VecX::Zero(rows);
  VecX z(r.size());
  const auto to_block = [&] {
    for (Eigen::Index row = 0; row < n; ++row) block[block_row_[row]] = fixed_[row] ? 0 : free[row];
  };
  const auto from_block = [&](const VecX& of) {
    for (Eigen::Index row = 0; row < n; ++row) {
      free[row] = 0;
      if (!fixed_[row]) free[row] = of[block_row_[row]];
    }
  };
  const Eigen::Map<const VecX> M(A_.inverse_diagonal.data(), rows);
  const VecX pressed = schur_.solve(r.tail(n_cells()));
  spread(b, pressed, free);
  to_block();
  from_block(times(block.cwiseProduct(M)).cwiseProduct(M));
  z.tail(n_cells()) = -schur_.solve(gather(b, free) + inverse_D_.cwiseProduct(pressed));
  free = VecX::Zero(n);
  spread(b, -z.tail(n_cells()), free);
  for (Eigen::Index row = 0; row < n; ++row)
    block[block_row_[row]] = r[row] + (fixed_[row] ? 0 : free[row]);
  VecX moved(rows);
  cycle_->apply(block.data(), moved.data());
  for (Eigen::Index row = 0; row < n; ++row) z[row] = moved[block_row_[row]];
  return z;
}

MixedSolver::Answer MixedSolver::solve(const Product& product, const std::vector<double>& b,
                                       const VecX& f, const VecX& g, double relative, int most,
                                       const Answer& from) const {
  const Eigen::Index n = f.size();
  const Eigen::Index cells = g.size();
  const Eigen::Index all = n + cells;
  VecX right(all), x = VecX::Zero(all), begin = VecX::Zero(all);
  right << f, g;
  const double wanted = relative * right.norm();
  if (from.d.size() > 0) {
    VecX of_f, of_g;
    product(from.d, from.q, of_f, of_g);
    begin << from.d, from.q;
    right.head(n) -= of_f;
    right.tail(cells) -= of_g;
  }
  if (right.norm() <= wanted) return {begin.head(n), begin.tail(cells), 0, true};
  petsc_module::Krylov system;
  system.n = static_cast<int>(all);
  system.product = [&](const double* from, double* to) {
    VecX y_f, y_g;
    product(Eigen::Map<const VecX>(from, n), Eigen::Map<const VecX>(from + n, cells), y_f, y_g);
    Eigen::Map<VecX>(to, n) = y_f;
    Eigen::Map<VecX>(to + n, cells) = y_g;
  };
  system.precondition = [&](const double* from, double* to) {
    Eigen::Map<VecX>(to, all) = apply(b, Eigen::Map<const VecX>(from, all));
  };
  system.right_side = right.data();
  system.solution = x.data();
  system.relative = wanted / right.norm();
  system.most = most;
  system.ranks = ranks_;
  const NoTraps in_petsc;
  const petsc_module::KrylovEnd end = module_.fgmres(system);
  x += begin;
  return {x.head(n), x.tail(cells), end.products, end.converged && x.allFinite()};
}

double MixedSolver::bytes() const {
  // A by rows, about as much again in its coarser levels and its incomplete factors; L; the vectors
  // of GMRES
  double entries = 0;
  if (!A_.start.empty()) entries = A_.start.back();
  double share = 1;
  if (ranks_) share = 1.0 / ranks_->n();
  return (ranks_ ? 4.7 : 2.6) * 12 * entries + schur_.size().factor_bytes +
         8.0 * 2 * 20 * share * (pattern_.n + n_cells());
}

}  // namespace langer
