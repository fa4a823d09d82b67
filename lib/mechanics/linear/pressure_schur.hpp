// L = B M^-1 B^T + D^-1 over the cells (linear/mixed.hpp), by Cholesky: a sparse matrix that joins
// cells with common nodes.
//
// Divided among ranks it stays exact, by substructuring: each rank eliminates the cells in its
// interior, which leaves a full matrix over the cells between ranks. Rank 0 factorizes that one.
#pragma once

#include <memory>
#include <vector>

#include "mechanics/assembly/division.hpp"
#include "mechanics/linear/linear.hpp"

namespace langer {

class PressureSchur {
 public:
  static constexpr int per_cell = 24;  // rows of a cell: hex8

  // cell_rows: (per_cell) of each cell, three rows for each node (-1: none); refers to the division
  // (nullptr: alone). threads: of the BLAS
  PressureSchur(std::vector<int> cell_rows, int n_rows, const Division* division, int threads);

  // scaled: (per_cell) by cell, B M^-1/2. False where L is not positive definite.
  bool factorize(const std::vector<double>& scaled, const VecX& inverse_D);
  VecX solve(const VecX& g) const;  // by cell
  LinearSolver::Size size() const;  // of this rank

 private:
  // The matrix of some cells, with the contributions of some nodes.
  struct Part {
    std::vector<int> cells;
    Pattern pattern;
    std::vector<char> node_counts;  // empty: all do
  };
  using CellsOf = std::vector<std::vector<int>>;  // by node

  Part part(std::vector<int> cells, std::vector<char> node_counts, const CellsOf& cells_of,
            int n_rim = 0) const;
  std::vector<double> values(const Part& part, const std::vector<double>& scaled) const;
  void divide(const CellsOf& cells_of);
  void take(const std::vector<int>& rank_of, const CellsOf& cells_of);
  bool factorize_between(const std::vector<double>& scaled, const VecX& inverse_D, bool eliminated);
  int n_cells() const { return static_cast<int>(cell_rows_.size()) / per_cell; }
  int n_own() const { return static_cast<int>(own_.cells.size() - rim_.size()); }

  std::vector<int> cell_rows_;
  int n_rows_, threads_;
  const Division* division_;
  Part own_;              // cells within, then those between ranks that they touch
  std::vector<int> rim_;  // the latter, as places in between_
  Part between_;
  std::unique_ptr<LinearSolver> solver_, solver_between_;  // the latter on rank 0
  VecX held_;        // added on the rim, so that what is left there is positive definite
  MatX rim_matrix_;  // Schur complement of the rim, with it
};

}  // namespace langer
