#include "mechanics/nonlinear/kinsol.hpp"

#include <fmt/format.h>
#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_version.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "core/base/text.hpp"
#include "core/base/traps.hpp"

namespace langer {

namespace {

using Map = Eigen::Map<VecX>;
Map map(N_Vector v) { return {N_VGetArrayPointer(v), static_cast<Eigen::Index>(N_VGetLength(v))}; }

// What KINSOL's callbacks share during one round.
struct Round {
  const FreeBalance& balance;
  const KinsolOptions& options;
  const Problem& problem;
  VecX x;  // all dofs; the free ones follow KINSOL's vector
  VecX f;  // residual on the free rows
  double tolerance = 0;
  VecX best;  // the iterate with the smallest residual: what KINSOL leaves in its vector may be
              // anything
  double least = std::numeric_limits<double>::infinity();
  int evaluations = 0, iterations = 0, setups = 0;
  bool fixed_tangent = false;

  void place(N_Vector u) {
    const Map v = map(u);
    for (Eigen::Index i = 0; i < v.size(); ++i) x[balance.free[i]] = v[i];
  }
};

// finite, and its square too, which KINSOL computes
bool measurable(const VecX& f) {
  return std::all_of(f.begin(), f.end(),
                     [](double one) { return std::isless(std::abs(one), 1e150); });
}

// > 0: KINSOL shortens its step; < 0: it gives up
int residual(N_Vector u, N_Vector f, void* data) {
  const Traps ours;
  auto& round = *static_cast<Round*>(data);
  if (++round.evaluations > 20 * round.options.iterations) return -1;
  if (round.problem.stopped && round.problem.stopped()) return -1;
  round.place(u);
  if (!measurable(round.x) || !round.balance.residual(round.x, round.f) || !measurable(round.f))
    return 1;
  map(f) = round.f;
  if (const double size = round.f.norm(); size < round.least) {
    round.least = size;
    round.best = round.x;
  }
  // accelerated iterations go on past the answer, where Anderson's system is singular: end them
  if (round.fixed_tangent && round.least <= 0.3 * round.tolerance) return -1;
  return 0;
}

// g(u) = u - K0^-1 f(u)
int fixed_point(N_Vector u, N_Vector g, void* data) {
  const Traps ours;
  auto& round = *static_cast<Round*>(data);
  if (const int failed = residual(u, g, data)) return failed;
  ++round.iterations;
  map(g) = map(u) - round.balance.solve(round.f, false);
  return map(g).allFinite() ? 0 : 1;
}

// The matrix is ours and stays ours: KINSOL sees an empty one, and a solver whose set-up is our
// factorization.
int jacobian(N_Vector, N_Vector, SUNMatrix, void*, N_Vector, N_Vector) { return 0; }
SUNMatrix_ID matrix_id(SUNMatrix) { return SUNMATRIX_CUSTOM; }
int matrix_zero(SUNMatrix) { return 0; }
SUNLinearSolver_Type solver_type(SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; }
int solver_setup(SUNLinearSolver solver, SUNMatrix) {
  const Traps ours;
  auto& round = *static_cast<Round*>(solver->content);
  if (round.fixed_tangent && round.setups > 0) return 0;
  ++round.setups;
  return round.balance.tangent(round.x) ? 0 : 1;
}
int solver_solve(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b, sunrealtype) {
  const Traps ours;
  auto& round = *static_cast<Round*>(solver->content);
  ++round.iterations;
  const VecX step = round.balance.solve(map(b), !round.fixed_tangent);
  if (!step.allFinite()) return 1;
  map(x) = step;
  return 0;
}

// Errors go to the context's handlers from SUNDIALS 7 on, to KINSOL's own before; neither may
// print: what failed is our report.
#if SUNDIALS_VERSION_MAJOR >= 7
int create(SUNContext* context) {
  const int failed = SUNContext_Create(SUN_COMM_NULL, context);
  if (failed) return failed;
  return SUNContext_ClearErrHandlers(*context);
}
void print_no_errors(void*) {}
#else
int create(SUNContext* context) { return SUNContext_Create(nullptr, context); }
void print_no_errors(void* memory) {
  KINSetErrHandlerFn(
      memory, [](int, const char*, const char*, char*, void*) {}, nullptr);
}
#endif

struct Context {
  SUNContext value = nullptr;
  Context() {
    if (create(&value)) throw std::runtime_error("KINSOL: no context");
  }
  ~Context() { SUNContext_Free(&value); }
  operator SUNContext() const { return value; }
};

template <class T, void (*release)(T)>
struct Owned {
  T value;
  ~Owned() {
    if (value) release(value);
  }
  operator T() const { return value; }
};
void free_memory(void* memory) { KINFree(&memory); }
void free_solver(SUNLinearSolver s) { SUNLinSolFreeEmpty(s); }
void free_matrix(SUNMatrix m) { SUNMatFreeEmpty(m); }

// Runs KINSOL from x; its own verdict is not asked for.
void solve_round(Round& round) {
  const Context context;
  const auto n = static_cast<sunindextype>(round.balance.free.size());
  const Owned<N_Vector, N_VDestroy> u{N_VNew_Serial(n, context)}, ones{N_VNew_Serial(n, context)};
  for (sunindextype i = 0; i < n; ++i) N_VGetArrayPointer(u)[i] = round.x[round.balance.free[i]];
  N_VConst(1, ones);
  const Owned<SUNMatrix, free_matrix> matrix{SUNMatNewEmpty(context)};
  matrix.value->ops->getid = matrix_id;
  matrix.value->ops->zero = matrix_zero;
  const Owned<SUNLinearSolver, free_solver> linear{SUNLinSolNewEmpty(context)};
  linear.value->content = &round;
  linear.value->ops->gettype = solver_type;
  linear.value->ops->setup = solver_setup;
  linear.value->ops->solve = solver_solve;

  const Owned<void*, free_memory> memory{KINCreate(context)};
  const KinsolOptions& o = round.options;
  const bool accelerated =
      o.strategy == KinsolStrategy::picard || o.strategy == KinsolStrategy::fixed_point;
  round.fixed_tangent = accelerated;
  if (accelerated && o.anderson > 0) KINSetMAA(memory, std::min<long>(o.anderson, n));
  KINSetNumMaxIters(memory, o.iterations);
  KINInit(memory, o.strategy == KinsolStrategy::fixed_point ? fixed_point : residual, u);
  KINSetUserData(memory, &round);
  print_no_errors(memory);
  if (o.strategy == KinsolStrategy::fixed_point) {
    if (!round.balance.tangent(round.x)) return;
  } else {
    KINSetLinearSolver(memory, linear, matrix);
    KINSetJacFn(memory, jacobian);
    KINSetMaxSetupCalls(memory, accelerated ? o.iterations + 1 : 1);
  }
  // KINSOL tests the largest component; a Newton step longer than this is shortened
  const double root = std::sqrt(static_cast<double>(n));
  KINSetFuncNormTol(
      memory, o.strategy == KinsolStrategy::fixed_point ? 1e-14 : 0.3 * round.tolerance / root);
  KINSetScaledStepTol(memory, 1e-15);
  KINSetMaxNewtonStep(memory, o.largest_move.value_or(round.problem.size) * root);
  const int strategies[] = {KIN_NONE, KIN_LINESEARCH, KIN_PICARD, KIN_FP};
  const NoTraps
      in_kinsol;  // Anderson's acceleration divides zero by zero where nothing changes any more
  KINSol(memory, u, strategies[static_cast<int>(o.strategy)], ones, ones);
}

}  // namespace

SolveReport kinsol(const Problem& problem, const FreeBalance& balance, VecX& x,
                   const KinsolOptions& options) {
  const double absolute = options.absolute.value_or(problem.least_force);
  SolveReport report;
  const auto stop = [&](Outcome outcome, std::string why) {
    report.outcome = outcome;
    report.why = std::move(why);
    return report;
  };
  for (int round = 0;; ++round) {
    if (is_stopped(problem, report)) return report;
    const Assessment now = problem.assess(x, true);
    ++report.evaluations;
    compare(now, absolute, options.relative, report);
    if (!now.admissible || !std::isfinite(now.residual))
      return stop(Outcome::inadmissible, text_or(now.missing, "a force is not finite"));
    const bool balanced = now.residual <= report.tolerance;
    if (round > 0 && balanced && now.others) return stop(Outcome::converged, "");
    if (round == options.rounds) {
      std::string why =
          fmt::format("residual {:.2e} N > {:.2e} N after {} rounds of KINSOL ({} iterations)",
                      now.residual, report.tolerance, round, report.iterations);
      if (balanced) why = fmt::format("{} after {} rounds of KINSOL", now.missing, round);
      return stop(Outcome::not_converged, std::move(why));
    }
    if (!take_step(problem, problem.correction(), x, options.largest_move, report)) return report;
    ++report.iterations;
    const Assessment then = problem.assess(x, false);
    ++report.evaluations;
    if (!then.admissible || !std::isfinite(then.residual))
      return stop(Outcome::inadmissible, text_or(then.missing, "a force is not finite"));
    Round inner{.balance = balance,
                .options = options,
                .problem = problem,
                .x = x,
                .f = VecX(static_cast<Eigen::Index>(balance.free.size()))};
    inner.tolerance = std::max({absolute, options.relative * then.reference, then.floor});
    if (then.residual > 0.3 * inner.tolerance) solve_round(inner);
    report.iterations += inner.iterations;
    report.evaluations += inner.evaluations;
    if (inner.best.size() > 0) x = inner.best;
  }
}

}  // namespace langer
