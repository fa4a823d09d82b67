// The border to PETSc: plain arrays over one function pointer each. PETSc brings MPI and fifty
// libraries; they live in a module, lib/langer/langer_petsc.so, that is loaded when a body is large
// enough for an iterative solution (petsc_load.hpp).
#pragma once

#include <functional>
#include <string>

#include "core/base/ranks.hpp"

namespace langer::petsc_module {

// A symmetric matrix in compressed rows; three rows for each node. The arrays have to stay where
// they are until the next setup. Of several ranks: what each adds to it, in rows of the whole; then
// the arrays may go.
struct Rows {
  int n = 0;
  const int *start = nullptr, *column = nullptr;
  const double* value = nullptr;
  const int* rank_of_node = nullptr;  // that has its rows; several ranks only
};

// What a Krylov method is told: vectors of n numbers each.
struct Krylov {
  int n = 0;
  std::function<void(const double*x, double*y)> product, precondition;
  const double* right_side = nullptr;
  double* solution = nullptr;  // where it ends; from zero
  double relative = 0;         // of the norm of the right side
  int most = 0;                // products
  const Ranks* ranks =
      nullptr;  // that share its vectors: each is given whole ones, the same on all; nullptr: none
};
struct KrylovEnd {
  bool converged = false;
  int products = 0;
};

// A cycle of algebraic multigrid by smoothed aggregation.
class Multigrid {
 public:
  virtual ~Multigrid() = default;
  // rigid: six movements that A hardly resists, one after the other. again: only the numbers are
  // others; aggregates and interpolation of the last setup stay. False: `why` has PETSc's words.
  virtual bool setup(const Rows& A, const double* rigid, bool again, std::string& why) = 0;
  virtual void apply(const double* r, double* z) = 0;
  virtual void times(const double* x, double* y) = 0;  // A x, of several ranks only
};

struct Functions {
  const char* made_with;  // version of the source; the program's own, or they do not fit together
  Ranks* (*ranks)(std::string& why);  // begins them; nullptr: they do not know of each other, `why`
  Multigrid* (*multigrid)(const Ranks* ranks);  // nullptr: of this process alone
  KrylovEnd (*fgmres)(const Krylov& system);    // flexible GMRES
  void (*end)();  // before the program ends: an mpirun that has started it wants to be told
};

inline constexpr const char* symbol = "langer_petsc_module";  // const Functions, of C linkage

}  // namespace langer::petsc_module
