// The module: the only code that calls PETSc.
#include <petscksp.h>

#include <cstdlib>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>

#include "base/version.hpp"
#include "linear/petsc/interface.hpp"

namespace langer::petsc_module {

namespace {

// PETSc has one state for the whole process
std::recursive_mutex mutex;

// where nobody can be told
void passed_over(PetscErrorCode) {}

void need(PetscErrorCode code) {
  if (code == 0) return;
  const char* text = nullptr;
  if (code == PETSC_ERR_MEM) throw std::bad_alloc();
  passed_over(PetscErrorMessage(code, &text, nullptr));
  throw std::runtime_error(text ? text : "an error without words");
}

bool begun = false;

void end() {
  if (begun) passed_over(PetscFinalize());
  begun = false;
}

// an environment variable while PETSc begins
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    value ? setenv(name, value, 1) : unsetenv(name);
  }
  ~Environment() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

void initialize() {
  // what users have set for programs of their own would change our digits
  const Environment none("PETSC_OPTIONS", nullptr);
  std::string name = "langer", skip = "-skip_petscrc";
  char* words[] = {name.data(), skip.data(), nullptr};
  char** arguments = words;
  int n = 2;
  if (std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv("PMIX_RANK")) {
    need(PetscInitialize(&n, &arguments, nullptr, nullptr));
    return;
  }
  // one process by itself: MPI need not look for others, nor for networks, and nothing is left in /tmp, however the program ends
  const Environment alone("OMPI_MCA_ess_singleton_isolated", "1"), self("OMPI_MCA_btl", "self"),
      folders("OMPI_MCA_orte_create_session_dirs", "0");
  need(PetscInitialize(&n, &arguments, nullptr, nullptr));
}

void begin() {
  if (begun) return;
  initialize();
  begun = true;
  need(PetscPopSignalHandler());  // signals are the program's
  need(PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr));
  for (const auto& [key, value] : {std::pair{"-langer_mg_levels_ksp_type", "chebyshev"},
                                   {"-langer_mg_levels_ksp_max_it", "1"},
                                   {"-langer_mg_levels_pc_type", "icc"}})
    need(PetscOptionsSetValue(nullptr, key, value));
}

class Aggregation : public Multigrid {
 public:
  ~Aggregation() override { clear(); }

  bool setup(const Rows& A, const double* rigid, bool again, std::string& why) override {
    const std::lock_guard alone(mutex);
    try {
      begin();
      if (again && A_)
        renew();
      else
        clear(), make(A, rigid);
      return true;
    } catch (const std::runtime_error& words) {
      why = words.what();
      clear();
      return false;
    }
  }

  void apply(const double* r, double* z) override {
    const std::lock_guard alone(mutex);
    need(VecPlaceArray(r_, r)), need(VecPlaceArray(z_, z));
    const PetscErrorCode applied = PCApply(cycle_, r_, z_);
    passed_over(VecResetArray(r_)), passed_over(VecResetArray(z_));
    need(applied);
  }

 private:
  void make(const Rows& A, const double* rigid) {
    need(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, A.n, A.n, const_cast<int*>(A.start), const_cast<int*>(A.column),
                                   const_cast<double*>(A.value), &A_));
    need(MatSetBlockSize(A_, 3));
    need(MatSetOption(A_, MAT_SPD, PETSC_TRUE));
    need(VecCreateSeqWithArray(PETSC_COMM_SELF, 3, A.n, nullptr, &r_));
    need(VecCreateSeqWithArray(PETSC_COMM_SELF, 3, A.n, nullptr, &z_));
    near_null_space(A.n, rigid);
    need(PCCreate(PETSC_COMM_SELF, &cycle_));
    need(PCSetType(cycle_, PCGAMG));
    need(PCSetOperators(cycle_, A_, A_));
    need(PCSetOptionsPrefix(cycle_, "langer_"));
    need(PCGAMGSetReuseInterpolation(cycle_, PETSC_TRUE));
    need(PCSetFromOptions(cycle_));
    need(PCSetUp(cycle_));
  }

  // other numbers in the same places: aggregates and what lies between levels stay
  void renew() {
    double* values = nullptr;  // PETSc takes them for changed
    need(MatSeqAIJGetArray(A_, &values));
    need(MatSeqAIJRestoreArray(A_, &values));
    need(PCSetUp(cycle_));
  }

  void near_null_space(int n, const double* rigid) {
    Vec modes[6];
    int kept = 0;
    for (int k = 0; k < 6; ++k) {
      Vec& mode = modes[kept];
      need(VecCreateSeq(PETSC_COMM_SELF, n, &mode));
      need(VecSetBlockSize(mode, 3));
      double* to = nullptr;
      need(VecGetArray(mode, &to));
      std::copy(rigid + static_cast<std::size_t>(k) * n, rigid + static_cast<std::size_t>(k + 1) * n, to);
      need(VecRestoreArray(mode, &to));
      double before = 0, after = 0;
      need(VecNorm(mode, NORM_2, &before));
      for (int j = 0; j < kept; ++j) {
        double along = 0;
        need(VecDot(mode, modes[j], &along));
        need(VecAXPY(mode, -along, modes[j]));
      }
      need(VecNormalize(mode, &after));
      if (after > 1e-10 * before)
        ++kept;
      else
        need(VecDestroy(&mode));
    }
    MatNullSpace space = nullptr;
    need(MatNullSpaceCreate(PETSC_COMM_SELF, PETSC_FALSE, kept, modes, &space));
    need(MatSetNearNullSpace(A_, space));
    need(MatNullSpaceDestroy(&space));
    for (int j = 0; j < kept; ++j) need(VecDestroy(&modes[j]));
  }

  void clear() {
    passed_over(PCDestroy(&cycle_));
    passed_over(VecDestroy(&r_)), passed_over(VecDestroy(&z_));
    passed_over(MatDestroy(&A_));
  }

  Mat A_ = nullptr;
  PC cycle_ = nullptr;
  Vec r_ = nullptr, z_ = nullptr;
};

Multigrid* multigrid() { return new Aggregation; }

// what PETSc calls back; it is C, so that exceptions have to go around it
struct Calls {
  const Krylov& system;
  std::exception_ptr thrown = nullptr;
};

// x -> y by a function of ours
PetscErrorCode call(Calls& calls, const std::function<void(const double*, double*)>& function, Vec x, Vec y) {
  const double* from = nullptr;
  double* to = nullptr;
  PetscCall(VecGetArrayRead(x, &from));
  PetscCall(VecGetArray(y, &to));
  try {
    function(from, to);
  } catch (...) {
    calls.thrown = std::current_exception();
  }
  PetscCall(VecRestoreArrayRead(x, &from));
  PetscCall(VecRestoreArray(y, &to));
  return static_cast<PetscErrorCode>(calls.thrown ? PETSC_ERR_USER : 0);
}

PetscErrorCode product(Mat matrix, Vec x, Vec y) {
  Calls* calls = nullptr;
  PetscCall(MatShellGetContext(matrix, &calls));
  return call(*calls, calls->system.product, x, y);
}

PetscErrorCode precondition(PC pc, Vec x, Vec y) {
  void* context = nullptr;
  PetscCall(PCShellGetContext(pc, &context));
  Calls& calls = *static_cast<Calls*>(context);
  return call(calls, calls.system.precondition, x, y);
}

KrylovEnd fgmres(const Krylov& system) {
  const std::lock_guard alone(mutex);
  constexpr int restart = 40;
  Mat matrix = nullptr;
  KSP method = nullptr;
  Vec b = nullptr, x = nullptr;
  KrylovEnd end;
  Calls calls{system};
  try {
    begin();
    need(MatCreateShell(PETSC_COMM_SELF, system.n, system.n, system.n, system.n, &calls, &matrix));
    need(MatShellSetOperation(matrix, MATOP_MULT, reinterpret_cast<void (*)()>(product)));
    need(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, system.n, system.right_side, &b));
    need(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, system.n, system.solution, &x));
    need(KSPCreate(PETSC_COMM_SELF, &method));
    need(KSPSetOperators(method, matrix, matrix));
    need(KSPSetType(method, KSPFGMRES));
    need(KSPGMRESSetRestart(method, restart));
    need(KSPSetTolerances(method, system.relative, 0, PETSC_DEFAULT, system.most));
    PC pc = nullptr;
    need(KSPGetPC(method, &pc));
    need(PCSetType(pc, PCSHELL));
    need(PCShellSetContext(pc, &calls));
    need(PCShellSetApply(pc, precondition));
    need(KSPSolve(method, b, x));
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    need(KSPGetConvergedReason(method, &reason));
    need(KSPGetIterationNumber(method, &end.products));
    end.converged = reason > 0;
  } catch (const std::runtime_error&) {
    end.converged = false;
  }
  passed_over(KSPDestroy(&method));
  passed_over(VecDestroy(&x)), passed_over(VecDestroy(&b));
  passed_over(MatDestroy(&matrix));
  try {
    if (calls.thrown) std::rethrow_exception(calls.thrown);
  } catch (const std::runtime_error&) {  // of multigrid: not converged
  }
  return end;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const Functions langer_petsc_module{version, multigrid, fgmres, end};

}  // namespace langer::petsc_module
