// The frictional contact problem of k candidates, condensed to their own unknowns. [A23] eqs 22-27
//   x = W r + q,   for each candidate (n, t1, t2):   r in the cone K_mu,
//   x_t + (x_n + mu |x_t|) n  in the dual cone, orthogonal to r                            [dSF98]
//   r (3k)      reactions [N], start value in and answer out
//   q (3k)      gap and slip without reactions [mm]
//   W (3k, 3k)  compliance [mm/N], positive semidefinite; a curved indenter makes it
//               slightly unsymmetric
// The second condition is the bipotential's form of both laws: no gap with a reaction, no slip
// below the limit, friction against the slip.
//
// Method: block Gauss-Seidel, one candidate after the other, by projection on the cone
// (coulomb_cone.hpp) with one rho each. Where it becomes slow, semismooth Newton steps follow
// (alart_curnier.hpp), and the proximal point method if W is singular. Whichever method found it,
// an answer is accepted by its residual in the natural map.
#pragma once

#include <vector>

#include "core/tensor/types.hpp"
#include "mechanics/contact/coulomb_cone.hpp"

namespace langer {

struct LocalProblem {
  MatX W;
  VecX q;
  VecX mu;  // (k)
  int n_contacts() const { return static_cast<int>(mu.size()); }
};

struct LocalReport {
  int sweeps = 0;        // Gauss-Seidel
  int newton_steps = 0;  // semismooth Newton
  double residual =
      0;  // natural map, relative to the largest reaction (or to rho |q| without reaction)
  bool converged = false;
  std::vector<ContactStatus> status;
};

struct LocalOptions {
  double tolerance = 1e-13;
  int sweeps = 2000;       // in all
  int newton_steps = 100;  // in all
  // Newton's method before the sweeps: if the problem has several solutions (W indefinite), it
  // finds the one next to the start value, the sweeps any.
  bool next_to_start = false;
};

LocalReport solve_local(const LocalProblem& problem, VecX& r, const LocalOptions& options = {});

}  // namespace langer
