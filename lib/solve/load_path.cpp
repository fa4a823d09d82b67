#include "solve/load_path.hpp"

#include <algorithm>
#include <cmath>

namespace langer {

PathReport load_path(const LoadPathOptions& options, double t, std::optional<double> increment, const std::vector<double>& stops,
                     const std::function<SolveReport(double t)>& attempt,
                     const std::function<bool(double t, double taken, double next, const SolveReport&)>& accepted) {
  constexpr double tiny = 1e-10;
  PathReport report;
  report.t = t;
  const double largest = options.largest_increment();
  double dt = increment.value_or(options.first_increment());
  while (t < 1 - tiny) {
    double stop = 1;
    for (double s : stops)
      if (s > t + tiny) stop = std::min(stop, s);
    double next = t + dt;
    // an increment that would leave a sliver before the stop is stretched or halved
    if (next > stop - tiny)
      next = stop;
    else if (next > stop - 0.5 * dt)
      next = dt <= 0.67 * largest ? stop : 0.5 * (t + stop);
    if (options.steps && std::abs(std::round(next * *options.steps) - next * *options.steps) < 1e-6)
      next = std::round(next * *options.steps) / *options.steps;
    const SolveReport solved = attempt(next);
    if (!solved.converged()) {
      ++report.cut_backs;
      report.why = solved.why;
      dt = 0.5 * (next - t);
      if (dt < options.smallest) return report;
      continue;
    }
    report.t = next, ++report.steps, report.iterations += solved.iterations, report.again += solved.again;
    const double taken = next - t;
    t = next;
    if (solved.iterations <= options.easy) dt = std::min(largest, std::max(dt, taken) * 1.5);
    if (!accepted(t, taken, dt, solved)) return report;
  }
  report.complete = true;
  return report;
}

}  // namespace langer
