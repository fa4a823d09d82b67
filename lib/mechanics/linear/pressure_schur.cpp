#include "mechanics/linear/pressure_schur.hpp"

#include <algorithm>

namespace langer {

namespace {

// full lower triangle
Pattern full(int n) {
  Pattern pattern;
  pattern.n = n;
  pattern.column_start.assign(1, 0);
  for (int column = 0; column < n; ++column) {
    for (int row = column; row < n; ++row) pattern.row.push_back(row);
    pattern.column_start.push_back(pattern.nnz());
  }
  return pattern;
}

}  // namespace

PressureSchur::PressureSchur(std::vector<int> cell_rows, int n_rows, const Division* division,
                             int threads)
    : cell_rows_(std::move(cell_rows)), n_rows_(n_rows), threads_(threads), division_(division) {
  CellsOf cells_of(static_cast<std::size_t>(n_rows / 3));
  for (int e = 0; e < n_cells(); ++e)
    for (int k = 0; k < per_cell; ++k)
      if (const int row = cell_rows_[per_cell * e + k]; row >= 0)
        if (std::vector<int>& cells = cells_of[row / 3]; cells.empty() || cells.back() != e)
          cells.push_back(e);
  if (division_) {
    divide(cells_of);
    return;
  }
  std::vector<int> all;
  for (int e = 0; e < n_cells(); ++e) all.push_back(e);
  own_ = part(std::move(all), {}, cells_of);
  solver_ = std::make_unique<LinearSolver>(own_.pattern, std::vector<int>{}, threads);
}

// n_rim: cells at the end that are eliminated last. Zeros join all others to the first of them, and
// each of them to the next, as where the cells of a rank fall apart the rim would not stay behind
// them all.
PressureSchur::Part PressureSchur::part(std::vector<int> cells, std::vector<char> node_counts,
                                        const CellsOf& cells_of, int n_rim) const {
  Part out{std::move(cells), {}, std::move(node_counts)};
  std::vector<int> place(static_cast<std::size_t>(n_cells()), -1);
  for (std::size_t i = 0; i < out.cells.size(); ++i) place[out.cells[i]] = static_cast<int>(i);
  out.pattern.n = static_cast<int>(out.cells.size());
  out.pattern.column_start.assign(1, 0);
  std::vector<int> neighbours;
  for (int i = 0; i < out.pattern.n; ++i) {
    neighbours.assign(1, i);
    for (int k = 0; k < per_cell; ++k)
      if (const int row = cell_rows_[per_cell * out.cells[i] + k];
          row >= 0 && (out.node_counts.empty() || out.node_counts[row / 3]))
        for (int f : cells_of[row / 3])
          if (place[f] > i) neighbours.push_back(place[f]);
    if (const int first = out.pattern.n - n_rim; n_rim > 0 && i + 1 < out.pattern.n)
      neighbours.push_back(std::max(first, i + 1));
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    out.pattern.row.insert(out.pattern.row.end(), neighbours.begin(), neighbours.end());
    out.pattern.column_start.push_back(static_cast<int>(out.pattern.row.size()));
  }
  return out;
}

// B M^-1 B^T of the part
std::vector<double> PressureSchur::values(const Part& part,
                                          const std::vector<double>& scaled) const {
  std::vector<double> out(part.pattern.row.size());
  std::vector<double> of_row(static_cast<std::size_t>(n_rows_), 0);  // entries of a cell
  const auto rows = [&](int e, auto&& each) {
    for (int k = 0; k < per_cell; ++k)
      if (const int row = cell_rows_[per_cell * e + k];
          row >= 0 && (part.node_counts.empty() || part.node_counts[row / 3]))
        each(of_row[row], scaled[per_cell * e + k]);
  };
  for (int i = 0; i < part.pattern.n; ++i) {
    rows(part.cells[i], [](double& in_row, double entry) { in_row += entry; });
    for (int at = part.pattern.column_start[i]; at < part.pattern.column_start[i + 1]; ++at) {
      double sum = 0;
      rows(part.cells[part.pattern.row[at]],
           [&](double in_row, double entry) { sum += entry * in_row; });
      out[at] = sum;
    }
    rows(part.cells[i], [](double& in_row, double) { in_row = 0; });
  }
  return out;
}

void PressureSchur::divide(const CellsOf& cells_of) {
  take(division_->rank_of, cells_of);
  const double between = static_cast<double>(between_.cells.size());
  const double largest = division_->ranks->largest(solver_ ? solver_->size().flops : 0);
  // among many ranks there is too much between them: rank 0 has all
  if (between * between * between / 3 > 4 * largest)
    take(std::vector<int>(static_cast<std::size_t>(n_cells()), 0), cells_of);
}

// Between ranks are cells with a neighbour of a higher one. A node of a cell within touches none of
// another rank's.
void PressureSchur::take(const std::vector<int>& rank_of, const CellsOf& cells_of) {
  const int rank = division_->ranks->rank();
  std::vector<char> lies_between(static_cast<std::size_t>(n_cells()), 0),
      counts(cells_of.size(), 0), counts_between(cells_of.size(), 0);
  for (const std::vector<int>& cells : cells_of)
    for (int e : cells)
      for (int f : cells) lies_between[e] = lies_between[e] || rank_of[f] > rank_of[e];
  std::vector<int> cells, rim, between;
  std::vector<char> on_rim(lies_between.size(), 0);
  for (int e = 0; e < n_cells(); ++e)
    if (lies_between[e])
      between.push_back(e);
    else if (rank_of[e] == rank)
      cells.push_back(e);
  for (std::size_t node = 0; node < cells_of.size(); ++node) {
    counts_between[node] = 1;
    for (int e : cells_of[node])
      if (!lies_between[e]) {
        counts_between[node] = 0;
        counts[node] = rank_of[e] == rank;
      }
    for (int e : cells_of[node])
      if (counts[node] && lies_between[e]) on_rim[e] = 1;
  }
  rim_.clear();
  std::vector<int> last;
  for (std::size_t i = 0; i < between.size(); ++i)
    if (on_rim[between[i]])
      last.push_back(static_cast<int>(cells.size())), rim_.push_back(static_cast<int>(i)),
          cells.push_back(between[i]);
  own_ = part(std::move(cells), std::move(counts), cells_of, static_cast<int>(rim_.size()));
  between_ = part(std::move(between), std::move(counts_between), cells_of);
  solver_.reset();
  solver_between_.reset();
  if (own_.pattern.n > 0)
    solver_ = std::make_unique<LinearSolver>(own_.pattern, std::move(last), threads_);
}

bool PressureSchur::factorize(const std::vector<double>& scaled, const VecX& inverse_D) {
  std::vector<double> L = values(own_, scaled);
  for (int i = 0; i < n_own(); ++i) L[own_.pattern.column_start[i]] += inverse_D[own_.cells[i]];
  if (!division_) return solver_->factorize(L);
  held_.resize(static_cast<Eigen::Index>(rim_.size()));
  for (std::size_t i = 0; i < rim_.size(); ++i) {
    double& diagonal = L[own_.pattern.column_start[n_own() + static_cast<int>(i)]];
    held_[static_cast<Eigen::Index>(i)] = diagonal, diagonal *= 2;
  }
  bool eliminated = !solver_ || solver_->factorize(L);
  if (eliminated && !rim_.empty()) {
    const std::optional<MatX> left = solver_->schur();
    eliminated = left.has_value();
    if (left) rim_matrix_ = *left;
  }
  return factorize_between(scaled, inverse_D, eliminated);
}

bool PressureSchur::factorize_between(const std::vector<double>& scaled, const VecX& inverse_D,
                                      bool eliminated) {
  const Ranks& ranks = *division_->ranks;
  if (ranks.largest(eliminated ? 0 : 1) > 0) return false;
  const int n = between_.pattern.n;
  if (n == 0) return true;
  MatX whole = MatX::Zero(n, n);
  if (ranks.first()) {
    const std::vector<double> L = values(between_, scaled);
    for (int i = 0; i < n; ++i) {
      for (int at = between_.pattern.column_start[i]; at < between_.pattern.column_start[i + 1];
           ++at)
        whole(between_.pattern.row[at], i) += L[at];
      whole(i, i) += inverse_D[between_.cells[i]];
    }
  }
  for (std::size_t j = 0; j < rim_.size(); ++j) {
    for (std::size_t i = j; i < rim_.size(); ++i) whole(rim_[i], rim_[j]) += rim_matrix_(i, j);
    whole(rim_[j], rim_[j]) -= held_[static_cast<Eigen::Index>(j)];
  }
  ranks.sum(whole.data(), static_cast<std::size_t>(whole.size()));
  int positive = 1;
  if (ranks.first()) {
    if (!solver_between_)
      solver_between_ = std::make_unique<LinearSolver>(full(n), std::vector<int>{}, threads_);
    std::vector<double> lower;
    for (int j = 0; j < n; ++j)
      lower.insert(lower.end(), whole.col(j).data() + j, whole.col(j).data() + n);
    positive = solver_between_->factorize(lower);
  }
  ranks.broadcast_from_root(&positive, sizeof positive);
  return positive != 0;
}

VecX PressureSchur::solve(const VecX& g) const {
  if (!division_) return solver_->solve(g);
  const Ranks& ranks = *division_->ranks;
  const int n = between_.pattern.n;
  VecX own = VecX::Zero(own_.pattern.n);
  VecX right = VecX::Zero(n);
  for (int i = 0; i < n_own(); ++i) own[i] = g[own_.cells[i]];
  LinearSolver::Half half;
  if (solver_ && n > 0) {
    half = solver_->start(own);
    const VecX condensed = rim_matrix_ * half.last;
    for (std::size_t i = 0; i < rim_.size(); ++i)
      right[rim_[i]] = condensed[static_cast<Eigen::Index>(i)];
  }
  if (n > 0) {
    ranks.sum(right.data(), static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) right[i] += g[between_.cells[i]];
    if (ranks.first()) right = solver_between_->solve(right);
    ranks.broadcast_from_root(right.data(), static_cast<std::size_t>(n) * sizeof(double));
  }
  VecX out = VecX::Zero(g.size());
  if (solver_ && n > 0) {
    VecX moved(half.last.size());
    for (std::size_t i = 0; i < rim_.size(); ++i)
      moved[static_cast<Eigen::Index>(i)] = right[rim_[i]];
    own = solver_->finish(half, rim_matrix_ * (moved - half.last));
  } else if (solver_) {
    own = solver_->solve(own);
  }
  for (int i = 0; i < n_own(); ++i) out[own_.cells[i]] = own[i];
  ranks.sum(out.data(), static_cast<std::size_t>(out.size()));
  for (int i = 0; i < n; ++i) out[between_.cells[i]] = right[i];
  return out;
}

LinearSolver::Size PressureSchur::size() const {
  LinearSolver::Size size = LinearSolver::Size{};
  if (solver_) size = solver_->size();
  const double n = between_.pattern.n;
  const double rim = static_cast<double>(rim_.size());
  size.factor_bytes += 8 * rim * rim + 8 * n * n;
  if (!division_ || !division_->ranks->first()) return size;
  size.factor_bytes += 16 * n * n;
  size.factor_nonzeros += n * n / 2;
  size.flops += n * n * n / 3;
  return size;
}

}  // namespace langer
