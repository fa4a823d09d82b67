#include "mechanics/nonlinear/load_path.hpp"

#include <algorithm>
#include <cmath>

namespace langer {

namespace {

constexpr double tiny = 1e-10;  // of the path: shorter differences are rounding

// The duration that `smallest` is a share of.
double shortest_stage(const LoadPathOptions& options, const std::vector<double>& stops) {
  if (!options.seconds) return 1;
  std::vector<double> ends = stops;
  ends.push_back(0);
  ends.push_back(1);
  std::sort(ends.begin(), ends.end());
  double shortest = 1;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const double length = ends[i] - ends[i - 1];
    if (length > tiny) shortest = std::min(shortest, length);
  }
  return shortest;
}

// Where the next increment may end: the stage of the path (between two stops where the path has
// seconds, all of it otherwise) and its longest increment.
struct Stage {
  double begin = 0, end = 1;
  double largest = 1;  // increment
};

Stage stage_at(const LoadPathOptions& options, double t, const std::vector<double>& stops) {
  Stage stage;
  for (double stop : stops) {
    if (stop > t + tiny) stage.end = std::min(stage.end, stop);
    if (options.seconds && stop <= t + tiny) stage.begin = std::max(stage.begin, stop);
  }
  stage.largest = options.largest_increment();
  if (options.seconds) stage.largest *= stage.end - stage.begin;
  if (options.fixed > 0) stage.largest = options.fixed;
  return stage;
}

// The end of an increment of about dt from t. One that would leave a sliver before the end of the
// stage is stretched to it or halved; `shortened` ones are not stretched again.
double end_of_increment(const LoadPathOptions& options, const Stage& stage, double t, double dt,
                        bool shortened) {
  double next = t + dt;
  if (next > stage.end - tiny)
    next = stage.end;
  else if (next > stage.end - 0.5 * dt && dt <= 0.67 * stage.largest && !shortened)
    next = stage.end;
  else if (next > stage.end - 0.5 * dt)
    next = 0.5 * (t + stage.end);
  if (!options.steps || options.seconds) return next;
  // sums of equal increments are kept from drifting
  const double in_steps = next * *options.steps;
  const double whole = std::round(in_steps);
  const bool on_grid = std::abs(whole - in_steps) < 1e-6 && whole / *options.steps > t + tiny;
  if (on_grid) return whole / *options.steps;
  return next;
}

}  // namespace

PathReport load_path(
    const LoadPathOptions& options, double t, std::optional<double> increment,
    const std::vector<double>& stops, const std::function<SolveReport(double t)>& attempt,
    const std::function<bool(double t, double taken, double next, const SolveReport&)>& accepted,
    const std::function<double(double t)>& cut) {
  PathReport report;
  report.t = t;
  // Every attempt that fails halves the increment, and none is shorter than this: so the attempts
  // at one increment are bounded, whatever the options.
  const double smallest = std::max(shortest_stage(options, stops) * options.smallest, tiny);
  double dt = increment.value_or(0);
  bool failed = false;     // the last attempt, from this t
  bool shortened = false;  // because of its error: then not to be stretched again
  while (t < 1 - tiny) {
    const Stage stage = stage_at(options, t, stops);
    if (dt == 0 && options.fixed > 0) dt = options.fixed;
    if (dt == 0) dt = (options.seconds ? stage.end - stage.begin : 1) * options.first_increment();
    if (options.seconds) {
      // equal increments begin anew in each stage; a halved one stays as it is
      const bool begins = std::abs(t - stage.begin) <= tiny && !failed;
      if (options.steps && begins) dt = stage.largest;
      dt = std::min(dt, stage.largest);
    }
    double next = end_of_increment(options, stage, t, dt, shortened);
    if (cut) next = cut(next);
    const SolveReport solved = attempt(next);
    if (solved.outcome == Outcome::stopped) {
      report.why = solved.why;
      return report;
    }
    if (!solved.converged()) {
      failed = true;
      ++report.cut_backs;
      report.why = solved.why;
      dt = 0.5 * (next - t);
      if (dt < smallest) return report;
      continue;
    }
    // errors grow with the third power of an increment
    double fits = 2;
    if (solved.time_error > 0) {
      fits = 0.9 * std::cbrt(options.time_error / solved.time_error);
    }
    if (!options.steps && solved.time_error > options.time_error && fits * (next - t) > smallest) {
      failed = true;
      shortened = true;
      ++report.too_long;
      dt = std::max(fits, 0.1) * (next - t);
      continue;
    }
    const double taken = next - t;
    t = next;
    failed = false;
    shortened = false;
    report.t = t;
    ++report.steps;
    report.iterations += solved.iterations;
    report.again += solved.again;
    // where the error of an increment is known it decides
    double growth = 1.5;
    if (!options.steps && solved.time_error > 0) growth = 2;
    if (solved.iterations <= options.easy)
      dt = std::min(stage.largest, std::max(dt, taken) * growth);
    if (!options.steps && solved.time_error > 0) dt = std::min(dt, fits * taken);
    if (!accepted(t, taken, dt, solved)) return report;
  }
  report.complete = true;
  return report;
}

}  // namespace langer
