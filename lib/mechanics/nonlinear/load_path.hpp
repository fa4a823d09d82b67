// Increments along a path t = 0 ... 1. Knows neither Newton's method nor contact.
//
// Each increment is attempted by the caller. A failed one is halved, down to `smallest`. After an
// easy one (few iterations) the next may be longer, up to `largest`. The path stops at each of
// `stops`, where a history has a kink. With a duration, `first` and `largest` are fractions of a
// stage, from one stop to the next, and the time error of viscous stresses or of inertia also
// limits the length. Increments depend on the results alone, so that an interrupted path continues
// with the same ones.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "mechanics/nonlinear/newton.hpp"

namespace langer {

// Increments of given length, in which the factor of all loads is an unknown
// (solve/border.hpp).
struct ArcLengthOptions {
  double length = 0;
  static void fields(auto& v) {
    v(&ArcLengthOptions::length, "length", unit::mm,
      "of the whole path: increments add up to it, each the root mean square movement of the nodes, to which those of indenters are "
      "added. t is the share of it that has been covered, and load_factor, a result, multiplies all loads, imposed displacements and ways "
      "of indenters",
      required, positive);
  }
};

struct LoadPathOptions {
  std::optional<int> steps;
  double first = 0.1, largest = 0.1, smallest = 1e-4;
  int easy = 6;
  std::optional<double> seconds;
  double time_error = 1e-3;
  std::optional<double> longest_attempt;  // [s], wall time
  std::optional<ArcLengthOptions> arc_length;

  double fixed = 0;  // of t: all increments of a body in motion; 0: as the others say

  double first_increment() const {
    if (steps) return 1.0 / *steps;
    return first;
  }
  double largest_increment() const {
    if (steps) return 1.0 / *steps;
    return largest;
  }
  // Of what adheres (solve/release.hpp): a jump is followed before the path gives up.
  double shortest_with_a_jump() const { return std::max(largest_increment() / 32, 2 * smallest); }
  // Where the surface passes an edge of an indenter within an increment longer than this, the
  // increment is halved (solve/edge_slip.hpp). Past a sharp edge every increment has to pass it.
  double shortest_past_an_edge() const { return largest_increment() / 64; }
  void use_increment(double increment) {
    steps.reset();
    first = largest = increment;
  }  // for all of the path

  static void fields(auto& v) {
    v(&LoadPathOptions::steps, "steps", unit::none,
      "number of equal increments, with seconds of each stage; first and largest follow from it",
      between(1, 1000000));
    v(&LoadPathOptions::first, "first", unit::none,
      "first increment, as a fraction of the path; with seconds: of the stage, which ends where a history has a kink",
      between(1e-9, 1));
    v(&LoadPathOptions::largest, "largest", unit::none, "largest increment, a fraction of the same",
      between(1e-6, 1));
    v(&LoadPathOptions::smallest, "smallest", unit::none,
      "increment below which the path is given up; with seconds a fraction of the shortest stage",
      positive, between(0, 1));
    v(&LoadPathOptions::easy, "easy", unit::none,
      "a step with at most this many iterations lets the next one grow", at_least(1));
    v(&LoadPathOptions::seconds, "seconds", unit::s,
      "duration of the path; what viscous materials need", positive);
    v(&LoadPathOptions::time_error, "time_error", unit::none,
      "of viscous materials: error of the branch stresses that an increment may make, over the greatest stresses, both as means over "
      "the body; of bonds with a viscosity: error of their intensity, as a mean over what has touched; not with steps",
      positive, between(0, 1));
    v(&LoadPathOptions::longest_attempt, "longest_attempt", unit::s,
      "wall time after which an attempt at an increment counts as failed and the increment is halved; none: no limit. With it "
      "the increments depend on the speed of the machine",
      positive);
    v(&LoadPathOptions::arc_length, "arc_length", unit::none,
      "follows the path of equilibria past limit points, where loads or imposed displacements turn back");
  }
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> found;
    if (!steps && first > largest)
      found.push_back({"first", "larger than largest", "first <= largest", ""});
    if (arc_length && seconds)
      found.push_back({"arc_length", "found together with seconds", "one of the two",
                       "the factor of the loads is a result, and no function of time"});
    if (smallest > first_increment())
      found.push_back({"smallest", "larger than the first increment", "a smaller one", ""});
    return found;
  }
};

struct PathReport {
  bool complete = false;
  int too_long = 0;    // increments begun again because of time_error
  double t = 0;        // reached
  int steps = 0;       // accepted
  int iterations = 0;  // of accepted steps
  int again = 0;       // corrections with their tangents
  int cut_backs = 0;
  std::string why;  // of the last failure, when not complete
};

// attempt(t): solve at t from the last accepted state; the callee keeps or restores its state.
// After an Outcome::stopped the path ends at once; other failures halve the increment. accepted(t,
// increment taken, next increment, report): false stops the path (the report is then not complete).
// stops: values of t that must be hit (kinks of the path); 1 is always one. With seconds they end
// the stages. cut(t): where an increment to t should end instead, not beyond t.
PathReport load_path(
    const LoadPathOptions& options, double t, std::optional<double> increment,
    const std::vector<double>& stops, const std::function<SolveReport(double t)>& attempt,
    const std::function<bool(double t, double taken, double next, const SolveReport&)>& accepted,
    const std::function<double(double t)>& cut = {});

}  // namespace langer
