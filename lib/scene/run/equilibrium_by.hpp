// The nonlinear solver that a config names.
#pragma once

#include "mechanics/nonlinear/kinsol.hpp"
#include "mechanics/nonlinear/newton.hpp"
#include "mechanics/solve/statics.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

// problem: statics.problem(), or that with somebody who watches
inline SolveReport equilibrium_by(const std::variant<NewtonOptions, KinsolOptions>& solver,
                                  Statics& statics, const Problem& problem) {
  if (const auto* options = std::get_if<KinsolOptions>(&solver))
    return kinsol(problem, statics.free_balance(), statics.trial(), *options);
  const NewtonOptions& options = std::get<NewtonOptions>(solver);
  const SolveReport report = newton(problem, statics.trial(), options);
  if (report.converged() || report.outcome == Outcome::stopped) return report;
  if (!problem.begins_again) return report;
  Problem anew = problem;  // the tangent of the state before led astray: the increment as it would
                           // be without one
  anew.begins_again = false;
  statics.restart();
  return newton(anew, statics.trial(), options);
}

inline SolveReport equilibrium_by(const std::variant<NewtonOptions, KinsolOptions>& solver,
                                  Statics& statics) {
  return equilibrium_by(solver, statics, statics.problem());
}

}  // namespace langer
