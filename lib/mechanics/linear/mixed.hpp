// Iterative solution near incompressibility, without a factor of K.
//
// The tangent of hexahedra with one dilatation each is K = A + B^T D B. A has a small bulk modulus,
// B (cells, rows) holds the gradients of the mean dilatations, D (cells) the large rest of the bulk
// modulus. D makes K too badly conditioned for iterations. With the volumetric forces q = D B d as
// unknowns of their own, the system is not:
//   [ A   B^T  ] [d]   [f]
//   [ B  -D^-1 ] [q] = [g]
// Flexible GMRES solves the system, preconditioned by its upper block triangle: for A a cycle of
// smoothed aggregation (algebraic multigrid), for the Schur complement            after [EHSST06]
//   S^-1 = L^-1 (B M^-1 A M^-1 B^T + D^-1) L^-1,   M = diag A,   L = B M^-1 B^T + D^-1 by Cholesky
// L contains the checkerboard pressures, to which hexahedra with one dilatation hardly react; a
// mass matrix does not. A reduction by 1e-4 needs 10 iterations, with a mass matrix 100 to 200.
//
// Divided among ranks, each holds what its own cells add to A and B. Vectors are whole, and the
// same on all ranks.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/tensor/types.hpp"
#include "mechanics/assembly/pattern.hpp"
#include "mechanics/linear/linear.hpp"
#include "mechanics/linear/petsc/petsc_interface.hpp"
#include "mechanics/linear/pressure_schur.hpp"

namespace langer {

class MixedSolver {
 public:
  static constexpr int per_cell = PressureSchur::per_cell;

  // dof_of_row: 3 node + axis of each row; cell_rows: (per_cell) of each cell, -1 where its dof is
  // prescribed. Refers to pattern, module and division (nullptr: alone).
  MixedSolver(const Pattern& pattern, const std::vector<int>& dof_of_row,
              std::vector<int> cell_rows, const petsc_module::Functions& module, int threads,
              const Division* division = nullptr);

  int n_cells() const { return static_cast<int>(cell_rows_.size()) / per_cell; }
  // b: (per_cell) by cell, the entries of B
  VecX gather(const std::vector<double>& b, const VecX& d) const;           // B d
  void spread(const std::vector<double>& b, const VecX& q, VecX& f) const;  // f += B^T q
  void spread_own(const std::vector<double>& b, const VecX& q,
                  VecX& f) const;  // the same of this rank's cells
  const Ranks* ranks() const { return ranks_; }

  // Sets up the preconditioner that solve() uses until the next call. A: lower triangle in the
  // pattern's order; fixed: rows without coupling in A or B; rigid: (rows, 6), rigid body motions.
  // False, with the reason in `why`, if PETSc fails.
  bool precondition(const std::vector<double>& A, const std::vector<double>& b, const VecX& D,
                    const std::vector<char>& fixed, const MatX& rigid, std::string& why);
  bool preconditioned() const { return preconditioned_; }
  void forget() {
    preconditioned_ = again_ = false;
  }  // so that a solution does not depend on earlier ones

  struct Answer {
    VecX d, q;
    int products = 0;
    bool converged = false;
  };
  // product: (f, g) of (d, q)
  using Product = std::function<void(const VecX& d, const VecX& q, VecX& f, VecX& g)>;
  // relative: what may be left of f and g together; from: where it begins, empty: from zero
  Answer solve(const Product& product, const std::vector<double>& b, const VecX& f, const VecX& g,
               double relative, int most, const Answer& from) const;

  VecX diagonal_of(const std::vector<double>& A) const;  // of all ranks
  double bytes() const;                                  // about, of what precondition() makes
  double entries() const { return static_cast<double>(pattern_.row.size()); }  // of A, one triangle
  LinearSolver::Size schur_size() const { return schur_.size(); }

 private:
  void fill(const std::vector<double>& A, const VecX& diagonal);
  bool factorize_schur(const std::vector<double>& b, const std::vector<char>& fixed);
  VecX apply(const std::vector<double>& b, const VecX& r) const;
  VecX times(const VecX& x) const;  // A, of all rows of the nodes

  const Pattern& pattern_;
  const petsc_module::Functions& module_;
  const Ranks* ranks_;
  std::vector<int> own_;           // cells
  std::vector<int> rank_of_node_;  // of several ranks
  std::vector<int> cell_rows_;
  std::vector<int> block_row_;  // of each row: 3 times the number of its node, plus its axis
  struct Rows {                 // of A, three for each node
    std::vector<int> start, column;
    std::vector<double> value, inverse_diagonal;
  };
  Rows A_;
  VecX inverse_D_;
  std::vector<char> fixed_;
  PressureSchur schur_;
  std::unique_ptr<petsc_module::Multigrid> cycle_;
  bool preconditioned_ = false, again_ = false;
};

}  // namespace langer
