#include "mechanics/solve/release.hpp"

#include <algorithm>
#include <limits>

#include "core/base/interrupt.hpp"

namespace langer {

namespace {

constexpr double most_loosened = 0.5;

double hardest_work(const Increment& increment) {
  double work = 0;
  for (const RigidContact& contact : increment.contacts())
    if (contact.adhesion) work = std::max(work, contact.adhesion->work);
  for (const SurfaceContact& surface : increment.surfaces())
    if (surface.adhesion) work = std::max(work, surface.adhesion->work);
  return work;
}

// Bonds come loose in parts, each an equilibrium: less damped while that is easy, more where it is
// not.
SolveReport let_go(Increment& increment, const std::function<SolveReport()>& solve,
                   const std::function<void(int)>& jumping) {
  constexpr int parts = 400;
  constexpr double settled = 0.05, undamped = 1e-3, stiffest = 1e9;
  const double work = hardest_work(increment);
  SolveReport all;
  Increment::Trial last = increment.saved_trial();
  double damping = work;
  for (int i = 0; i < parts && damping < stiffest * work && !interrupted(); ++i) {
    jumping(i);
    increment.bonds().go_on();
    increment.bonds().damp(damping);
    SolveReport part = solve();
    all.iterations += part.iterations;
    all.again += part.again;
    all.evaluations += part.evaluations;
    const double loosened = increment.bonds().loosened();
    if (!part.converged() || (damping == 0 && loosened > settled)) {
      increment.bonds().damp(std::numeric_limits<double>::infinity());  // as they were
      increment.restore_trial(last);
      if (damping == 0) {
        damping = 0.1 * work;
      } else {
        damping = 8 * damping;
      }
      continue;
    }
    if (damping == 0) {
      part.iterations = all.iterations;
      part.again = all.again;
      part.evaluations = all.evaluations;
      return part;
    }
    last = increment.saved_trial();
    if (loosened < settled)
      damping *= 0.1;
    else if (part.iterations <= 6)
      damping *= 0.5;
    if (damping < undamped * work) damping = 0;
  }
  all.outcome = Outcome::not_converged;
  all.why = "the bonds of the adhesion find no state in which they rest";
  return all;
}

}  // namespace

SolveReport adhesive_equilibrium(Increment& increment, double t, double shortest,
                                 const std::function<SolveReport()>& solve,
                                 const std::function<void(int)>& jumping) {
  const double from = increment.accepted().t;
  SolveReport report = solve();
  double loosened = 0;
  if (report.converged()) loosened = increment.bonds().loosened();
  if (report.converged() && loosened <= most_loosened) return report;
  if (t - from > shortest) {
    if (report.converged())
      report.why = "bonds of the adhesion lose more than half of their intensity in one increment";
    report.outcome = Outcome::not_converged;
    return report;
  }
  increment.begin(t);
  const double at_begin = increment.accepted().in_bonds.stored;
  increment.bonds().damp(std::numeric_limits<double>::infinity());
  SolveReport held = solve();
  if (!held.converged()) return held;
  const double before = increment.stored();
  const VecX u = increment.trial();
  SolveReport jump = let_go(increment, solve, jumping);
  jump.iterations += report.iterations + held.iterations;
  jump.again += report.again + held.again;
  if (!jump.converged()) return jump;
  const double of_loads = increment.work_of_loads(u);
  increment.jumped(before - at_begin + of_loads,
                   before - increment.stored() + of_loads -
                       increment.bonds().dissipated_since(increment.accepted().bonds));
  return jump;
}

}  // namespace langer
