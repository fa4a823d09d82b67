// Assembler in an increment where indenters adhere.
// Bonds soften, and where more of the body's energy waits than they can take, they let go in a
// jump: there is no equilibrium near the last one. Then, in an increment that is short enough,
// equilibrium is followed from that of the bonds as they were, by bonds that come loose as slowly
// as needed, b dbeta/dt with the greatest b first, to b = 0. What their viscosity takes is the
// energy released.
#pragma once

#include <functional>

#include "mechanics/nonlinear/newton.hpp"
#include "mechanics/solve/statics.hpp"

namespace langer {

// begun: an increment to t, which `solve` brings to equilibrium; shortest: an increment of t in
// which a jump may be. Not converged where a bond loses more than half of its intensity, or nothing
// converges, in a longer one. jumping: told in a jump how many equilibria were looked for so far. A
// signal ends it between two of them, not converged.
SolveReport adhesive_equilibrium(Statics& statics, double t, double shortest,
                                 const std::function<SolveReport()>& solve,
                                 const std::function<void(int)>& jumping);

}  // namespace langer
