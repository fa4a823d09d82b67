#include "solve/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace langer {

bool take_step(const Problem& problem, VecX& x, double largest_move, SolveReport& report) {
  const std::optional<VecX> dx = problem.correction();
  if (!dx || !dx->allFinite()) {
    report.outcome = Outcome::singular, report.why = "the tangent is singular, or the body gives way in many directions at once";
    return false;
  }
  const double longest = dx->lpNorm<Eigen::Infinity>();
  double step = longest > largest_move ? largest_move / longest : 1;
  int halvings = 0;
  while (!problem.admissible(x + step * *dx) && ++halvings <= 8) step *= 0.5;
  if (halvings > 8) {
    report.outcome = Outcome::inadmissible, report.why = "no admissible step: elements would be turned inside out";
    return false;
  }
  problem.moved(*dx, step);
  x += step * *dx;
  return true;
}

SolveReport newton(const Problem& problem, VecX& x, const NewtonOptions& options) {
  SolveReport report;
  const auto stop = [&](Outcome outcome, std::string why) {
    report.outcome = outcome, report.why = std::move(why);
    return report;
  };
  for (;; ++report.iterations) {
    const Assessment now = problem.assess(x, true);
    report.residual = now.residual, report.reference = now.reference;
    report.tolerance = std::max({options.absolute, options.relative * now.reference, now.floor});
    if (!now.admissible || !std::isfinite(now.residual))
      return stop(Outcome::inadmissible, now.missing.empty() ? "a force is not finite" : now.missing);
    const bool balanced = now.residual <= report.tolerance;
    if (report.iterations > 0 && balanced && now.others) return stop(Outcome::converged, "");
    if (report.iterations == options.iterations)
      return stop(Outcome::not_converged, balanced ? fmt::format("{} after {} iterations", now.missing, report.iterations)
                                                   : fmt::format("residual {:.2e} N > {:.2e} N after {} iterations",
                                                                 now.residual, report.tolerance, report.iterations));
    if (!take_step(problem, x, options.largest_move, report)) return report;
  }
}

}  // namespace langer
