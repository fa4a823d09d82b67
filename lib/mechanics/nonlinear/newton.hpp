// Newton's method for a problem given as functions: it knows no mechanics.   [A23] section 2.5
//   f(x) = 0:   K dx = -f(x),  x <- x + dx,  until |f| <= relative * reactions and `others` hold
// The Problem's functions:
//   assess(x, with_tangent)   residual and tangent at x; what is missing to convergence
//   correction()              dx by the tangent at the last assessed x; empty: not solvable
//   correction_again()        dx at the last assessed x by the tangent of the last correction();
//                             empty: that tangent does not serve
//   begins_again              the tangent of the state before serves for the first correction
//   admissible(x)             cheap test that x can be assessed (det F > 0)
//   moved(dx, step)           called before x becomes x + step dx
//   stopped()                 whether the user asked for an end; called before every iteration
//   size, least_force         of the body: limits that the options do not name follow from them
// A step is halved until it is admissible, but not until the residual falls: near incompressibility
// the first residuals of a step are large by nature.
//
// Modified Newton: a new tangent costs `cost_ratio` corrections with an old one. The old one is
// kept while its linear convergence reaches the end sooner. What it leaves is as large as the
// residual shows, whereas a new tangent would have squared it. Such a solution therefore has to
// reach a hundredth of the usual tolerance, unless the user set a wider one.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "core/tensor/types.hpp"
#include "mechanics/linear/linear_by.hpp"

namespace langer {

struct Assessment {
  bool admissible = true;
  double residual = 0;   // norm [N]
  double reference = 0;  // the force it is compared with [N]
  double floor = 0;      // what rounding alone leaves of it [N]
  bool others =
      true;  // conditions beside the residual hold (contact law, prescribed values reached)
  std::string missing;  // which of them does not
};

struct Problem {
  std::function<Assessment(const VecX& x, bool with_tangent)> assess;
  std::function<std::optional<VecX>()> correction;
  std::function<std::optional<VecX>()>
      correction_again;   // none: every correction takes a new tangent
  double cost_ratio = 0;  // of correction() in units of correction_again()
  bool begins_again = false;
  std::function<bool(const VecX& x)> admissible;
  std::function<void(const VecX& dx, double step)> moved;
  std::function<bool()> stopped;  // none: nobody can
  double size = 1;                // [mm]
  double least_force = 1e-12;     // [N]
};

struct NewtonOptions {
  static constexpr const char* key = "newton";
  int iterations = 25;
  double relative = 1e-6;
  std::optional<double> absolute;      // [N]; none: Problem::least_force
  std::optional<double> largest_move;  // [mm]; none: Problem::size
  bool reuse_tangent = true;
  LinearBy linear = LinearBy::automatic;
  static void fields(auto& v) {
    v(&NewtonOptions::iterations, "iterations", unit::none,
      "largest number of tangents in one step", at_least(1));
    v(&NewtonOptions::relative, "relative", unit::none,
      "residual allowed, relative to the reactions", positive, between(0, 0.1));
    v(&NewtonOptions::absolute, "absolute", unit::N,
      "residual allowed where there is no reaction; none: 1e-14 of shear modulus times largest extent squared",
      at_least(0));
    v(&NewtonOptions::reuse_tangent, "reuse_tangent", unit::none,
      "within a step, correct with the last tangent for as long as that is cheaper than a new one; false: a new one each time");
    v(&NewtonOptions::linear, "linear", unit::none,
      "direct: by a factor of the tangent; iterative: by multigrid and GMRES, in less memory and time where the body is large, without a look at the "
      "stability of the equilibrium; auto: iterative from 100 000 free dofs on, where the scene and the installation allow it");
    v(&NewtonOptions::largest_move, "largest_move", unit::mm,
      "longest movement of a node in one iteration; none: the largest extent of the body",
      positive);
  }
};

enum class Outcome { converged, not_converged, inadmissible, singular, stopped };

struct SolveReport {
  Outcome outcome = Outcome::not_converged;
  int iterations = 0;   // each with a tangent of its own, that of the state before included
  int again = 0;        // corrections with the tangent of an iteration
  int evaluations = 0;  // of the residual
  double residual = 0, tolerance = 0, reference = 0;
  double asked = 0;       // tolerance before it was raised to what rounding leaves [N]
  std::string why;        // in words, when not converged
  double time_error = 0;  // of a viscous body: ViscousPoints::error()
  bool converged() const { return outcome == Outcome::converged; }
};

// residual, reference and both tolerances of a state
void compare(const Assessment& now, double absolute, double relative, SolveReport& report);

// A correction, shortened where it is too long or would turn elements inside out; false: `report`
// says why.
bool take_step(const Problem& problem, const std::optional<VecX>& dx, VecX& x,
               const std::optional<double>& largest_move, SolveReport& report);

// Whether the user asked for an end; `report` then says so.
bool is_stopped(const Problem& problem, SolveReport& report);

SolveReport newton(const Problem& problem, VecX& x, const NewtonOptions& options);

}  // namespace langer
