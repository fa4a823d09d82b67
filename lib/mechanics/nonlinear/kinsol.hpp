// SUNDIALS' KINSOL in the place of newton(): same problem, same convergence test, same report.
// Each round is one linearised step, which brings in imposed displacements and solves the contact
// law, and then KINSOL on the free unknowns with the contact reactions fixed; rounds end when the
// law holds at equilibrium.
//   newton       full steps, a new tangent each               linesearch   the same, steps shortened where |f| grows
//   picard       one tangent per round                        fixed_point  the same as a fixed-point iteration
// anderson: number of earlier steps that accelerate picard and fixed_point.
// Guards that KINSOL needs: it takes NaN for success or hangs on it, so a residual that is not
// finite is reported as recoverable and |f| is evaluated again after every return; its longest step
// defaults to 1000 |u0| and is set here; its number of evaluations is limited.
#pragma once

#include "mechanics/nonlinear/free_balance.hpp"
#include "mechanics/nonlinear/newton.hpp"

namespace langer {

enum class KinsolStrategy { newton, linesearch, picard, fixed_point };
constexpr auto names(KinsolStrategy) {
  return std::array{"newton", "linesearch", "picard", "fixed_point"};
}

struct KinsolOptions {
  static constexpr const char* key = "kinsol";
  KinsolStrategy strategy = KinsolStrategy::linesearch;
  int anderson = 5;
  int iterations = 100;
  int rounds = 25;
  double relative = 1e-6;
  std::optional<double> absolute;      // [N]; none: Problem::least_force
  std::optional<double> largest_move;  // [mm]; none: Problem::size
  static void fields(auto& v) {
    v(&KinsolOptions::strategy, "strategy", unit::none, "how KINSOL iterates");
    v(&KinsolOptions::anderson, "anderson", unit::none,
      "earlier steps used by picard and fixed_point", between(0, 50));
    v(&KinsolOptions::iterations, "iterations", unit::none,
      "largest number of KINSOL iterations in one round", at_least(1));
    v(&KinsolOptions::rounds, "rounds", unit::none, "largest number of rounds in one step",
      at_least(1));
    v(&KinsolOptions::relative, "relative", unit::none,
      "residual allowed, relative to the reactions", positive, between(0, 0.1));
    v(&KinsolOptions::absolute, "absolute", unit::N,
      "residual allowed where there is no reaction; none: 1e-14 of shear modulus times largest extent squared",
      at_least(0));
    v(&KinsolOptions::largest_move, "largest_move", unit::mm,
      "longest movement of a node in one iteration; none: the largest extent of the body",
      positive);
  }
};

SolveReport kinsol(const Problem& problem, const FreeBalance& balance, VecX& x,
                   const KinsolOptions& options);

}  // namespace langer
