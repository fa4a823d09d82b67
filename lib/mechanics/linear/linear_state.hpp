// What the files of LinearSolver share: CHOLMOD's and UMFPACK's objects.
#pragma once

#include <cholmod.h>
#include <omp.h>
#include <umfpack.h>

#include <Eigen/Dense>
#include <mutex>
#include <vector>

#include "core/tensor/dense.hpp"
#include "mechanics/linear/blas/blas.hpp"
#include "mechanics/linear/linear.hpp"

namespace langer {

// CHOLMOD opens parallel regions of its own, whatever OMP_NUM_THREADS is, and they take the cores
// from the BLAS that it calls: 0.68 s instead of 0.19 s for a factor of 38 000 unknowns on two
// cores. This guard prevents them during a call. Not so with an OpenBLAS that is built with OpenMP
// and uses several threads: it would wait for threads that it never gets.
class NoNestedThreads {
 public:
  NoNestedThreads() : levels_(omp_get_max_active_levels()) {
    if (!blas::waits_for_openmp()) omp_set_max_active_levels(0);
  }
  ~NoNestedThreads() { omp_set_max_active_levels(levels_); }

 private:
  int levels_;
};

// METIS uses the C library's only rand(), which it seeds for each ordering. Two orderings at the
// same time would mix their random numbers and differ from run to run.
inline std::lock_guard<std::mutex> one_ordering_at_a_time() {
  static std::mutex mutex;
  return std::lock_guard(mutex);
}

struct LinearSolver::State {
  cholmod_common common;
  cholmod_sparse* A = nullptr;
  cholmod_factor* L = nullptr;
  // tril(P A P^T) in the order of L, made with the first factor of an order: CHOLMOD would
  // otherwise permute A twice before each factor, which takes longer than a small factor itself
  cholmod_sparse* permuted = nullptr;
  std::vector<int> permuted_from;   // entry of permuted -> entry of A
  std::vector<int> fill_reducing;   // rows in the order of small fill
  std::vector<int> last;            // rows to eliminate last
  std::vector<int> place_of;        // row -> index in `last`, or -1
  bool trailing = false;            // the last rows of L are those of `last`
  std::vector<int> trailing_order;  // i-th trailing row of L -> index in `last`
  mutable MatX trailing_block;      // of the present factor, once asked for
  struct Full {                     // fallback: the full matrix by columns
    std::vector<int> start, row, from;
    std::vector<double> value;
    void* symbolic = nullptr;
    void* numeric = nullptr;
  };
  Full full;
  bool indefinite = false;
  std::vector<int> springs;  // rows with springs in the factor; empty in most
  MatX spring_moves;         // (n, springs): K^-1 of a unit force on each spring, springs included
  Lu spring_share;

  ~State() {
    if (full.numeric) umfpack_di_free_numeric(&full.numeric);
    if (full.symbolic) umfpack_di_free_symbolic(&full.symbolic);
    cholmod_free_factor(&L, &common);
    cholmod_free_sparse(&permuted, &common);
    cholmod_free_sparse(&A, &common);
    cholmod_finish(&common);
  }

  void begin(const Pattern& pattern, int threads);
  void analyse();
  void take_last(std::vector<int> rows);
  void order_last();
  void permute_pattern();
  bool cholesky();                  // of A as it is
  VecX whole(const VecX& b) const;  // by the CHOLMOD factor, springs included
  bool factorize_indefinite();
  const MatX& trailing_factor() const;
  bool halves() const { return trailing && !indefinite && springs.empty(); }
  VecX through(int system, const VecX& b) const;
};

}  // namespace langer
