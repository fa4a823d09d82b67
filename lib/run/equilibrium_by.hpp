// The nonlinear solver that a config names.
#pragma once

#include "scene/solve_config.hpp"
#include "solve/kinsol.hpp"
#include "solve/newton.hpp"

namespace langer {

inline SolveReport equilibrium_by(const std::variant<NewtonOptions, KinsolOptions>& solver, const Problem& problem, VecX& u) {
  if (const auto* options = std::get_if<KinsolOptions>(&solver)) return kinsol(problem, u, *options);
  return newton(problem, u, std::get<NewtonOptions>(solver));
}

}  // namespace langer
