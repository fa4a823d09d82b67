// Direct solution of K x = b for the symmetric tangent: CHOLMOD supernodal, and UMFPACK where K is
// not positive definite. The pattern is analysed once.
//
// Contact needs the compliance of its nodes. Their rows, `last`, are eliminated last. In blocks,
//   K = [K11 K12; K21 K22],   L = [L1 0; X L2],   L2 L2^T = S = K22 - K21 K11^-1 K12
// the last block L2 of the Cholesky factor is that of the Schur complement S, and forces on these
// rows alone move them by S^-1 = L2^-T L2^-1: compliance() costs no solution with the whole factor.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/tensor/types.hpp"
#include "mechanics/assembly/pattern.hpp"

namespace langer {

class LinearSolver {
 public:
  // threads: of the BLAS under CHOLMOD
  LinearSolver(const Pattern& pattern, std::vector<int> last = {}, int threads = 1);
  // Rows in a given order of elimination, such as order() of a matrix that is nearly the same.
  struct Order {
    explicit Order(std::vector<int> of) : rows(std::move(of)) {}
    std::vector<int> rows;
  };
  LinearSolver(const Pattern& pattern, Order order, int threads);
  ~LinearSolver();

  // The order of elimination with small fill, before the rows of `last` are moved to its end.
  const std::vector<int>& order() const;

  // Other rows to eliminate last. The next thing is a factorization.
  void eliminate_last(std::vector<int> last);

  // By CHOLMOD; false if K is not positive definite. solve() then needs another factorization.
  bool factorize(const std::vector<double>& values);
  // By UMFPACK, whatever the signs; false where K is singular.
  bool factorize_indefinite(const std::vector<double>& values);
  // By CHOLMOD with springs added to a few rows, those at which Cholesky stops: at least one for
  // each negative eigenvalue. solve() and compliance() remove their effect exactly (Woodbury).
  // False if `most` of them are not enough.
  bool factorize_with_springs(const std::vector<double>& values, int most = 40);
  VecX solve(const VecX& b) const;

  // The same in two halves, for a b whose part on the rows of `last` (the contacts) depends on x
  // there:
  //   half = start(b);   half.last is x on those rows, in their order;   finish(half, c) = K^-1 (b + c), c on the rows of `last`
  struct Half {
    VecX last;
    VecX rest;  // L^-1 P b, or x itself where there is no such factor
  };
  Half start(const VecX& b) const;
  VecX finish(const Half& half, const VecX& c) const;

  // B^T K^-1 B, for B with rows of `last` only: B is (last.size(), m), rows in the order of `last`
  MatX compliance(const MatX& B) const;

  // The Schur complement of the rows of `last`, in their order; nothing if the present factor does
  // not contain it
  std::optional<MatX> schur() const;
  // Negative pivots of a simplicial L D L^T: as many as there are negative eigenvalues. -1 where a
  // pivot is zero. Slower than a factor; the factor that solve() uses stays.
  int negative_pivots(const std::vector<double>& values);

  struct Size {
    double nonzeros = 0;         // of K, one triangle
    double factor_nonzeros = 0;  // of its Cholesky factor
    double factor_bytes = 0;     // memory of a factorization, in addition to that of the analysis
    double flops = 0;            // of one factorization
  };
  Size size() const;  // known from the analysis

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace langer
