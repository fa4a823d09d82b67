// The nonlinear solver that a config names.
#pragma once

#include "mechanics/nonlinear/kinsol.hpp"
#include "mechanics/nonlinear/newton.hpp"
#include "mechanics/solve/increment.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

// problem: increment.problem(), or that with somebody who watches
inline SolveReport equilibrium_by(const std::variant<NewtonOptions, KinsolOptions>& solver,
                                  Increment& increment, const Problem& problem) {
  if (const auto* options = std::get_if<KinsolOptions>(&solver))
    return kinsol(problem, increment.free_balance(), increment.trial(), *options);
  const NewtonOptions& options = std::get<NewtonOptions>(solver);
  const SolveReport report = newton(problem, increment.trial(), options);
  if (report.converged() || report.outcome == Outcome::stopped) return report;
  if (!problem.begins_again) return report;
  Problem anew = problem;  // the tangent of the state before led astray: the increment as it would
                           // be without one
  anew.begins_again = false;
  increment.restart();
  return newton(anew, increment.trial(), options);
}

inline SolveReport equilibrium_by(const std::variant<NewtonOptions, KinsolOptions>& solver,
                                  Increment& increment) {
  return equilibrium_by(solver, increment, increment.problem());
}

}  // namespace langer
