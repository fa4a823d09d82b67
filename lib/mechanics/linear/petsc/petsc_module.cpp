// The module: the only code that calls PETSc.
#include <unistd.h>
#ifdef LANGER_SANITIZE
#include <sanitizer/lsan_interface.h>
#endif

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <list>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/base/version.hpp"
#include "mechanics/linear/petsc/calls.hpp"

namespace langer::petsc_module {

std::recursive_mutex mutex;

void passed_over(PetscErrorCode) {}

void need(PetscErrorCode code) {
  if (code == 0) return;
  const char* text = nullptr;
  if (code == PETSC_ERR_MEM) throw std::bad_alloc();
  passed_over(PetscErrorMessage(code, &text, nullptr));
  throw std::runtime_error(text ? text : "an error without words");
}

namespace {

bool begun = false;

void end() {
  if (begun) passed_over(PetscFinalize());
  begun = false;
}

// an environment variable while PETSc begins
class Environment {
 public:
  Environment(std::string name, const char* value) : name_(std::move(name)) {
    if (const char* before = std::getenv(name_.c_str())) before_ = before;
    value ? setenv(name_.c_str(), value, 1) : unsetenv(name_.c_str());
  }
  ~Environment() { before_ ? setenv(name_.c_str(), before_->c_str(), 1) : unsetenv(name_.c_str()); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const std::string name_;
  std::optional<std::string> before_;
};

// Signals are the program's: PETSc and MPI take some of them, and give them back as they are to
// programs that do nothing about them.
class Signals {
 public:
  Signals() {
    for (int k = 1; k < n; ++k) known_[k] = sigaction(k, nullptr, &actions_[k]) == 0;
  }
  ~Signals() {
    for (int k = 1; k < n; ++k)
      if (known_[k]) sigaction(k, &actions_[k], nullptr);
  }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

 private:
  static constexpr int n = 32;
  bool known_[n] = {};
  struct sigaction actions_[n] = {};
};

// what tells MPI of processes that were started together
std::list<std::string> names_of_launchers() {
  std::list<std::string> names;
  for (char** entry = environ; *entry; ++entry)
    for (const char* begins : {"OMPI_", "PMIX_", "PMI_", "SLURM_"})
      if (std::strncmp(*entry, begins, std::strlen(begins)) == 0)
        names.emplace_back(*entry, std::strcspn(*entry, "="));
  return names;
}

// A build with sanitizers does not report what MPI allocates as it starts and never frees.
class LeaksOfMpi {
 public:
#ifdef LANGER_SANITIZE
  LeaksOfMpi() { __lsan_disable(); }
  ~LeaksOfMpi() { __lsan_enable(); }
#else
  LeaksOfMpi() = default;
  ~LeaksOfMpi() {}  // not trivial, so that an unused guard is no warning
#endif
  LeaksOfMpi(const LeaksOfMpi&) = delete;
  LeaksOfMpi& operator=(const LeaksOfMpi&) = delete;
};

void initialize(bool of_all_ranks) {
  const LeaksOfMpi not_ours;
  // what users have set for programs of their own would change our digits
  const Environment none("PETSC_OPTIONS", nullptr);
  std::string name = "langer";
  std::string skip = "-skip_petscrc";
  char* words[] = {name.data(), skip.data(), nullptr};
  char** arguments = words;
  int n = 2;
  if (of_all_ranks ||
      (launched().n == 1 && (std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv("PMIX_RANK")))) {
    need(PetscInitialize(&n, &arguments, nullptr, nullptr));
    return;
  }
  std::list<Environment>
      hidden;  // of others that were started with this one and have no part in its work
  for (const std::string& launcher : names_of_launchers()) hidden.emplace_back(launcher, nullptr);
  // one process by itself: MPI need not look for others, nor for networks, and nothing is left in
  // /tmp, however the program ends
  const Environment alone("OMPI_MCA_ess_singleton_isolated", "1"), self("OMPI_MCA_btl", "self"),
      folders("OMPI_MCA_orte_create_session_dirs", "0");
  need(PetscInitialize(&n, &arguments, nullptr, nullptr));
}

}  // namespace

void begin(bool of_all_ranks) {
  if (begun) return;
  {
    const Signals programs;
    initialize(of_all_ranks);
    begun = true;
    need(PetscPopSignalHandler());
  }
  need(PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr));
  for (const auto& [key, value] :
       {std::pair{"-langer_mg_levels_ksp_type", "chebyshev"},
        {"-langer_mg_levels_ksp_max_it", "1"},
        {"-langer_mg_levels_pc_type", "icc"},
        {"-langer_ranks_mg_levels_ksp_type", "chebyshev"},
        {"-langer_ranks_mg_levels_ksp_max_it", "1"},
        {"-langer_ranks_mg_levels_pc_type", "bjacobi"},  // of the rows of a rank
        {"-langer_ranks_mg_levels_sub_pc_type", "icc"}})
    need(PetscOptionsSetValue(nullptr, key, value));
}

void set_near_null_space(Mat A, const std::function<const double*(int)>& values, int n_modes) {
  std::vector<Vec> modes;
  for (int k = 0; k < n_modes; ++k) {
    Vec mode = nullptr;
    need(MatCreateVecs(A, &mode, nullptr));
    int rows = 0;
    need(VecGetLocalSize(mode, &rows));
    double* to = nullptr;
    need(VecGetArray(mode, &to));
    std::copy(values(k), values(k) + rows, to);
    need(VecRestoreArray(mode, &to));
    double before = 0, after = 0;
    need(VecNorm(mode, NORM_2, &before));
    for (Vec earlier : modes) {
      double along = 0;
      need(VecDot(mode, earlier, &along));
      need(VecAXPY(mode, -along, earlier));
    }
    need(VecNormalize(mode, &after));
    if (after > 1e-10 * before)
      modes.push_back(mode);
    else
      need(VecDestroy(&mode));
  }
  MatNullSpace space = nullptr;
  need(MatNullSpaceCreate(PetscObjectComm(reinterpret_cast<PetscObject>(A)), PETSC_FALSE,
                          static_cast<int>(modes.size()), modes.data(), &space));
  need(MatSetNearNullSpace(A, space));
  need(MatNullSpaceDestroy(&space));
  for (Vec& mode : modes) need(VecDestroy(&mode));
}

void make_aggregation(PC& cycle, Mat A, const char* options) {
  need(PCCreate(PetscObjectComm(reinterpret_cast<PetscObject>(A)), &cycle));
  need(PCSetType(cycle, PCGAMG));
  need(PCSetOperators(cycle, A, A));
  need(PCSetOptionsPrefix(cycle, options));
  need(PCGAMGSetReuseInterpolation(cycle, PETSC_TRUE));
  need(PCSetFromOptions(cycle));
}

namespace {

class Aggregation : public Multigrid {
 public:
  ~Aggregation() override { clear(); }

  bool setup(const Rows& A, const double* rigid, bool again, std::string& why) override {
    const std::lock_guard alone(mutex);
    try {
      begin();
      if (again && A_)
        renew();
      else {
        clear();
        make(A, rigid);
      }
      return true;
    } catch (const std::runtime_error& words) {
      why = words.what();
      clear();
      return false;
    }
  }

  void apply(const double* r, double* z) override {
    const std::lock_guard alone(mutex);
    need(VecPlaceArray(r_, r));
    need(VecPlaceArray(z_, z));
    const PetscErrorCode applied = PCApply(cycle_, r_, z_);
    passed_over(VecResetArray(r_));
    passed_over(VecResetArray(z_));
    need(applied);
  }

  void times(const double*, double*) override {
    throw std::logic_error("of one process, which has the matrix itself");
  }

 private:
  void make(const Rows& A, const double* rigid) {
    need(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, A.n, A.n, const_cast<int*>(A.start),
                                   const_cast<int*>(A.column), const_cast<double*>(A.value), &A_));
    need(MatSetBlockSize(A_, 3));
    need(MatSetOption(A_, MAT_SPD, PETSC_TRUE));
    need(VecCreateSeqWithArray(PETSC_COMM_SELF, 3, A.n, nullptr, &r_));
    need(VecCreateSeqWithArray(PETSC_COMM_SELF, 3, A.n, nullptr, &z_));
    set_near_null_space(
        A_, [&](int k) { return rigid + static_cast<std::size_t>(k) * A.n; }, 6);
    make_aggregation(cycle_, A_, "langer_");
    need(PCSetUp(cycle_));
  }

  // other numbers in the same places: aggregates and what lies between levels stay
  void renew() {
    double* values = nullptr;  // PETSc takes them for changed
    need(MatSeqAIJGetArray(A_, &values));
    need(MatSeqAIJRestoreArray(A_, &values));
    need(PCSetUp(cycle_));
  }

  void clear() {
    passed_over(PCDestroy(&cycle_));
    passed_over(VecDestroy(&r_));
    passed_over(VecDestroy(&z_));
    passed_over(MatDestroy(&A_));
  }

  Mat A_ = nullptr;
  PC cycle_ = nullptr;
  Vec r_ = nullptr, z_ = nullptr;
};

Multigrid* multigrid(const Ranks* ranks) {
  if (ranks) return multigrid_of(*ranks);
  return new Aggregation;
}

// what PETSc calls back; it is C, so that exceptions have to go around it
struct Calls {
  const Krylov& system;
  std::optional<Shares> shares = {};     // of vectors, among ranks
  std::vector<double> whole_x, whole_y;  // then
  std::exception_ptr thrown = nullptr;
};

// x -> y by a function of ours
PetscErrorCode call(Calls& calls, const std::function<void(const double*, double*)>& function,
                    Vec x, Vec y) {
  const double* from = nullptr;
  double* to = nullptr;
  PetscCall(VecGetArrayRead(x, &from));
  PetscCall(VecGetArray(y, &to));
  try {
    if (calls.shares) {
      calls.shares->gather(from, calls.whole_x.data());
      function(calls.whole_x.data(), calls.whole_y.data());
      std::copy_n(calls.whole_y.data() + calls.shares->before(), calls.shares->own(), to);
    } else {
      function(from, to);
    }
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

std::optional<Shares> shares_of(const Krylov& system) {
  if (!system.ranks) return {};
  std::vector<int> counts;
  const int parts = system.ranks->n();
  for (int k = 0; k < parts; ++k)
    counts.push_back(system.n / parts + (k < system.n % parts ? 1 : 0));
  return Shares(std::move(counts));
}

KrylovEnd fgmres(const Krylov& system) {
  const std::lock_guard alone(mutex);
  constexpr int restart = 40;
  Mat matrix = nullptr;
  KSP method = nullptr;
  Vec b = nullptr;
  Vec x = nullptr;
  KrylovEnd end;
  Calls calls{system};
  try {
    begin();
    calls.shares = shares_of(system);
    const MPI_Comm all = calls.shares ? PETSC_COMM_WORLD : PETSC_COMM_SELF;
    int own = system.n;
    if (calls.shares) own = calls.shares->own();
    int before = 0;
    if (calls.shares) before = calls.shares->before();
    if (calls.shares) {
      calls.whole_x.resize(system.n);
      calls.whole_y.resize(system.n);
    }
    const auto share = [&](const double* values, Vec* of) {
      need(calls.shares ? VecCreateMPIWithArray(all, 1, own, system.n, values + before, of)
                        : VecCreateSeqWithArray(all, 1, own, values, of));
    };
    need(MatCreateShell(all, own, own, system.n, system.n, &calls, &matrix));
    need(MatShellSetOperation(matrix, MATOP_MULT, reinterpret_cast<void (*)()>(product)));
    share(system.right_side, &b);
    share(system.solution, &x);
    need(KSPCreate(all, &method));
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
    if (calls.shares) {
      calls.shares->gather(system.solution + before, calls.whole_x.data());
      std::copy(calls.whole_x.begin(), calls.whole_x.end(), system.solution);
    }
  } catch (const std::runtime_error&) {
    if (system.ranks) throw;  // the others have seen nothing of it
    end.converged = false;
  }
  passed_over(KSPDestroy(&method));
  passed_over(VecDestroy(&x));
  passed_over(VecDestroy(&b));
  passed_over(MatDestroy(&matrix));
  try {
    if (calls.thrown) std::rethrow_exception(calls.thrown);
  } catch (const std::runtime_error&) {  // of multigrid: not converged
  }
  return end;
}

}  // namespace

extern "C" __attribute__((visibility("default")))
const Functions langer_petsc_module{version, world, multigrid, fgmres, end};

}  // namespace langer::petsc_module
