// The contact problem of a body that is restrained by its contacts only, or unstable without them.
// Springs E on the candidates make the tangent of the body positive definite; their effect is then
// removed exactly:
//   x = q + W s        position of each contact (n, t1, t2) when the supported body carries the forces s
//   r = b + A s        true reaction: what is left of s after the springs' share,  A = 1 - E W
//   r in K_mu,  x_t + (x_n + mu |x_t|) n  in the dual cone, orthogonal to r
// A may be singular (a body held only by contact), so the unknown is s. Semismooth Newton
// (Alart-Curnier form) on all contacts with damping; converges quadratically from the reactions of
// the last iteration.
#pragma once

#include "mechanics/contact/local_problem.hpp"

namespace langer {

struct SupportedProblem {
  MatX W, A;
  VecX q, b;
  VecX mu;
  int n_contacts() const { return static_cast<int>(mu.size()); }
};

// s: start value in and answer out; status and residual as in LocalReport
LocalReport solve_supported(const SupportedProblem& problem, VecX& s,
                            const LocalOptions& options = {});

}  // namespace langer
