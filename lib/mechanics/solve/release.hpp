// Equilibrium of an increment in which adhesive bonds break.
//
// Bonds soften. Where the body stores more energy than they can take, no equilibrium is near the
// last one, and the bonds break in a jump. An increment that is short enough for a jump then
// follows it through states that are not in equilibrium with the bonds:
//   -b dbeta/dt = beta s - w      with an artificial viscosity b of the bonds
// b is as large as Newton's method needs to converge. It falls from one state to the next, and is 0
// in the last one, which is an equilibrium. The work of b is the energy released (column
// energy_released).
#pragma once

#include <functional>

#include "mechanics/nonlinear/newton.hpp"
#include "mechanics/solve/increment.hpp"

namespace langer {

// begun: an increment to t, which `solve` brings to equilibrium; shortest: an increment of t in
// which a jump may be. Not converged where a bond loses more than half of its intensity, or nothing
// converges, in a longer one. jumping: told in a jump how many equilibria were looked for so far. A
// signal ends it between two of them, not converged.
SolveReport adhesive_equilibrium(Increment& increment, double t, double shortest,
                                 const std::function<SolveReport()>& solve,
                                 const std::function<void(int)>& jumping);

}  // namespace langer
