#include "mechanics/nonlinear/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include "core/base/text.hpp"

namespace langer {

void compare(const Assessment& now, double absolute, double relative, SolveReport& report) {
  report.residual = now.residual;
  report.reference = now.reference;
  report.asked = std::max(absolute, relative * now.reference);
  report.tolerance = std::max(report.asked, now.floor);
}

bool is_stopped(const Problem& problem, SolveReport& report) {
  if (!problem.stopped || !problem.stopped()) return false;
  report.outcome = Outcome::stopped;
  report.why = "stopped by a signal";
  return true;
}

bool take_step(const Problem& problem, const std::optional<VecX>& dx, VecX& x,
               const std::optional<double>& largest_move, SolveReport& report) {
  if (!dx || !dx->allFinite()) {
    report.outcome = Outcome::singular;
    report.why = "the tangent is singular, or the body is unstable in many directions at once";
    return false;
  }
  const double longest = dx->lpNorm<Eigen::Infinity>();
  const double limit = largest_move.value_or(problem.size);
  double step = 1;
  if (longest > limit) step = limit / longest;
  int halvings = 0;
  while (!problem.admissible(x + step * *dx) && ++halvings <= 8) step *= 0.5;
  if (halvings > 8) {
    report.outcome = Outcome::inadmissible;
    report.why = "no admissible step: elements would be turned inside out";
    return false;
  }
  problem.moved(*dx, step);
  x += step * *dx;
  return true;
}

namespace {

// Whether the tangent in hand is worth another correction.
class OldTangent {
 public:
  explicit OldTangent(double cost_ratio) : cost_ratio_(cost_ratio) {}
  // an increment in which nothing moves, as of a viscous body that is held: its contacts are found,
  // its residual is small, and stays about the same when the first correction has moved the branch
  // stresses into the volume
  void begins(const Assessment& first) {
    rests_ = first.others && first.residual < 0.1 * first.reference;
  }
  void renewed() {
    used_ = 0;
    of_before_ = false;
  }
  void that_of_before() {
    used_ = 1;
    of_before_ = true;
  }
  bool used() const { return used_ > 0; }
  // residual before the next correction, and the one wanted
  bool serves(double residual, double wanted) {
    // what the last correction left
    double share = 1;
    if (before_ > 0) share = residual / before_;
    before_ = residual;
    if (used_ == 0)
      return any_ && (share < 0.1 || rests_);  // not while a long step still finds its contacts
    if (of_before_ && share >= 0.1) return false;
    // where switches of fibres turn on and off, an old tangent may undo what a new one did, for
    // ever
    if (share > 0.3) return any_ = false;
    if (used_ > cost_ratio_ + 2) return false;
    if (residual <= wanted) return true;  // something else is missing
    const double to_go = std::log(wanted / residual) / std::log(share);
    return to_go <= cost_ratio_ + 1;  // a new tangent will need one correction more as well
  }
  void corrected() { ++used_; }

 private:
  double cost_ratio_, before_ = 0;  // residual
  int used_ = 0;                    // since it was made
  bool of_before_ = false;          // made where the step begins
  bool any_ = true;                 // serves in this step at all
  bool rests_ = false;
};

}  // namespace

SolveReport newton(const Problem& problem, VecX& x, const NewtonOptions& options) {
  double strict = 1e-2;
  if (options.relative > NewtonOptions{}.relative) strict = 1;
  const double absolute = options.absolute.value_or(problem.least_force);
  SolveReport report;
  const auto stop = [&](Outcome outcome, std::string why) {
    report.outcome = outcome;
    report.why = std::move(why);
    return report;
  };
  const bool reuses = options.reuse_tangent && problem.correction_again;
  OldTangent old(problem.cost_ratio);
  const bool at_hand = reuses && problem.begins_again;
  for (;;) {
    if (is_stopped(problem, report)) return report;
    const Assessment now = problem.assess(x, (report.iterations == 0 && !at_hand) || !reuses);
    ++report.evaluations;
    compare(now, absolute, options.relative, report);
    if (!now.admissible || !std::isfinite(now.residual))
      return stop(Outcome::inadmissible, text_or(now.missing, "a force is not finite"));
    if (report.evaluations == 1) old.begins(now);
    double wanted = report.tolerance;
    if (old.used()) {
      wanted = std::max({absolute, strict * options.relative * now.reference, now.floor});
    }
    const bool balanced = now.residual <= wanted;
    if (report.iterations > 0 && balanced && now.others) return stop(Outcome::converged, "");
    std::optional<VecX> dx;
    const bool first = at_hand && report.iterations == 0;
    if (reuses && ((old.serves(now.residual, wanted) && report.iterations > 0) || first))
      dx = problem.correction_again();
    if (dx && first) {
      old.that_of_before();
      ++report.iterations;
    } else if (dx) {
      old.corrected();
      ++report.again;
    } else {
      if (report.iterations == options.iterations)
        return stop(Outcome::not_converged,
                    balanced ? fmt::format("{} after {} iterations", now.missing, report.iterations)
                             : fmt::format("residual {:.2e} N > {:.2e} N after {} iterations",
                                           now.residual, report.tolerance, report.iterations));
      dx = problem.correction();
      old.renewed();
      ++report.iterations;
    }
    if (!take_step(problem, dx, x, options.largest_move, report)) return report;
  }
}

}  // namespace langer
