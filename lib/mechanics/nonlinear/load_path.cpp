#include "mechanics/nonlinear/load_path.hpp"

#include <algorithm>
#include <cmath>

namespace langer {

namespace {

double shortest_stage(const LoadPathOptions& options, const std::vector<double>& stops,
                      double tiny) {
  if (!options.seconds) return 1;
  std::vector<double> ends = stops;
  ends.push_back(0), ends.push_back(1);
  std::sort(ends.begin(), ends.end());
  double shortest = 1;
  for (std::size_t i = 1; i < ends.size(); ++i)
    if (ends[i] - ends[i - 1] > tiny) shortest = std::min(shortest, ends[i] - ends[i - 1]);
  return shortest;
}

}  // namespace

PathReport load_path(
    const LoadPathOptions& options, double t, std::optional<double> increment,
    const std::vector<double>& stops, const std::function<SolveReport(double t)>& attempt,
    const std::function<bool(double t, double taken, double next, const SolveReport&)>& accepted) {
  constexpr double tiny = 1e-10;
  PathReport report;
  report.t = t;
  const double shortest = shortest_stage(options, stops, tiny);
  double dt = increment ? *increment : 0;
  bool shortened = false;  // because of its error: then not to be stretched again
  while (t < 1 - tiny) {
    double stop = 1, begin = 0;
    for (double s : stops) {
      if (s > t + tiny) stop = std::min(stop, s);
      if (options.seconds && s <= t + tiny) begin = std::max(begin, s);
    }
    const double stage = options.seconds ? stop - begin : 1;
    const double largest = stage * options.largest_increment();
    if (dt == 0) dt = stage * options.first_increment();
    if (options.seconds) dt = options.steps ? largest : std::min(dt, largest);
    double next = t + dt;
    // an increment that would leave a sliver before the stop is stretched or halved
    if (next > stop - tiny)
      next = stop;
    else if (next > stop - 0.5 * dt)
      next = dt <= 0.67 * largest && !shortened ? stop : 0.5 * (t + stop);
    if (options.steps && !options.seconds &&
        std::abs(std::round(next * *options.steps) - next * *options.steps) < 1e-6)
      next = std::round(next * *options.steps) / *options.steps;
    const SolveReport solved = attempt(next);
    if (!solved.converged()) {
      ++report.cut_backs;
      report.why = solved.why;
      dt = 0.5 * (next - t);
      if (dt < shortest * options.smallest) return report;
      continue;
    }
    // errors grow with the third power of an increment
    const double fits =
        solved.time_error > 0 ? 0.9 * std::cbrt(options.time_error / solved.time_error) : 2;
    if (!options.steps && solved.time_error > options.time_error &&
        fits * (next - t) > shortest * options.smallest) {
      ++report.too_long, shortened = true;
      dt = std::max(fits, 0.1) * (next - t);
      continue;
    }
    report.t = next, ++report.steps, report.iterations += solved.iterations,
    report.again += solved.again;
    const double taken = next - t;
    t = next, shortened = false;
    // where the error of an increment is known it decides
    const double growth = !options.steps && solved.time_error > 0 ? 2 : 1.5;
    if (solved.iterations <= options.easy) dt = std::min(largest, std::max(dt, taken) * growth);
    if (!options.steps && solved.time_error > 0) dt = std::min(dt, fits * taken);
    if (!accepted(t, taken, dt, solved)) return report;
  }
  report.complete = true;
  return report;
}

}  // namespace langer
