#include "mechanics/linear/complex_solver.hpp"

#include <umfpack.h>

#include <algorithm>
#include <new>

#include "mechanics/linear/linear_state.hpp"

namespace langer {

struct ComplexSolver::State {
  SparseXc A;
  void* symbolic = nullptr;
  void* numeric = nullptr;

  ~State() { release(); }
  void release() {
    if (numeric) umfpack_zi_free_numeric(&numeric);
    if (symbolic) umfpack_zi_free_symbolic(&symbolic);
  }
  // UMFPACK takes the real and imaginary parts of a number side by side.
  const double* values() const { return reinterpret_cast<const double*>(A.valuePtr()); }
};

namespace {

bool worked(int status) {
  if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
  return status == UMFPACK_OK;
}

bool same_pattern(const SparseXc& a, const SparseXc& b) {
  if (a.rows() != b.rows() || a.nonZeros() != b.nonZeros()) return false;
  return std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.outerSize() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr());
}

}  // namespace

ComplexSolver::ComplexSolver() : state_(std::make_unique<State>()) {}
ComplexSolver::~ComplexSolver() = default;

bool ComplexSolver::factorize(const SparseXc& A) {
  State& s = *state_;
  const NoNestedThreads guard;
  const bool known = s.symbolic && same_pattern(A, s.A);
  if (!known) s.release();
  if (s.numeric) umfpack_zi_free_numeric(&s.numeric);
  s.A = A;
  s.A.makeCompressed();
  const int n = static_cast<int>(A.rows());
  if (n == 0) return true;
  double control[UMFPACK_CONTROL];
  umfpack_zi_defaults(control);
  control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
  control[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;
  if (!known) {
    const auto alone = one_ordering_at_a_time();
    if (!worked(umfpack_zi_symbolic(n, n, s.A.outerIndexPtr(), s.A.innerIndexPtr(), s.values(),
                                    nullptr, &s.symbolic, control, nullptr)))
      return false;
  }
  return worked(umfpack_zi_numeric(s.A.outerIndexPtr(), s.A.innerIndexPtr(), s.values(), nullptr,
                                   s.symbolic, &s.numeric, control, nullptr));
}

VecXc ComplexSolver::solve(const VecXc& b) const {
  const State& s = *state_;
  VecXc x(b.size());
  if (b.size() == 0) return x;
  const NoNestedThreads guard;
  double control[UMFPACK_CONTROL];
  umfpack_zi_defaults(control);
  umfpack_zi_solve(UMFPACK_A, s.A.outerIndexPtr(), s.A.innerIndexPtr(), s.values(), nullptr,
                   reinterpret_cast<double*>(x.data()), nullptr,
                   reinterpret_cast<const double*>(b.data()), nullptr, s.numeric, control, nullptr);
  return x;
}

}  // namespace langer
