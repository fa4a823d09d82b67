#include "accuracy/estimate/report_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "accuracy/checks/progress.hpp"
#include "accuracy/estimate/impact_errors.hpp"
#include "core/base/interrupt.hpp"
#include "scene/run/dry_run.hpp"

namespace langer {

namespace {

constexpr double worth_it = 1.0 / 3;  // estimate by other meshes: share of the solve's time

bool has_numbers(const SolveConfig& config) {
  return config.mesh && has_numbers_of_cells(config.mesh->geometry);
}

// About the CPU seconds of the estimate; 0 if it solves nothing again.
double estimate_forecast(const SolveConfig& config, const std::optional<Material>& material,
                         const Run::Where& where, Run& run) {
  if (!by_refinement(config) || !has_numbers(config)) return 0;
  const double estimate = estimate_seconds(config, material, where);
  if (config.estimate == EstimateBy::refinement) return estimate;
  if (estimate <= worth_it * forecast_of(config, run.body, run.increment, run.scene).seconds()) {
    return estimate;
  }
  return 0;
}

// The cost of half the error: by smaller elements, and by shorter increments. With e ~ h^p and
// a time that grows as h^-q, half the mesh error costs the factor 2^(q/p).
void report_costs(const Voice& voice, const PathErrors& found) {
  if (found.growth == 0 || found.at_end.empty()) return;
  const ErrorEstimate& first = found.at_end.front();
  constexpr double slow = 0.9;  // order below which smaller elements cost too much
  if (first.grows || first.order < slow) return;
  std::string words = fmt::format("half the cells' part of {} takes about {:.2g} times the time",
                                  first.of.name, std::pow(2, found.growth / first.order));
  if (first.increments != 0)
    words += fmt::format(", half the increments' part {:.2g} times", std::sqrt(2));
  voice.detail("{}", words);
}

// What a scene is solved for: what `accuracy` judges, forces, torques, travels and the results of
// an impact.
bool is_main_result(const ErrorEstimate& e) {
  return e.asked || e.of.of_force() || e.of.of_travel() || is_of_impact(e.of.name);
}

bool has_estimate(const std::vector<ErrorEstimate>& estimates, const std::string& name) {
  return std::ranges::any_of(estimates, [&](const ErrorEstimate& e) { return e.of.name == name; });
}

}  // namespace

EstimateBy estimate_of(const Voice& voice, const SolveConfig& config,
                       const std::optional<Material>& material, const Run::Where& where, Run& run) {
  const bool asked = config.estimate.has_value();
  if (asked && config.estimate != EstimateBy::automatic) return *config.estimate;
  if (asked && estimate_forecast(config, material, where, run) > 0) return EstimateBy::automatic;
  EstimateBy cheap = EstimateBy::none;
  if (recovered_by_default(config, run)) cheap = EstimateBy::recovery;
  if (!asked) return cheap;
  std::string why = "the cells follow from no numbers of this config";
  if (has_numbers(config)) why = "other meshes would take more than a third of the solve";
  if (cheap == EstimateBy::recovery)
    voice.detail("errors are estimated by recovery: {}", why);
  else
    voice.say(
        "errors are not estimated: {}, and recovery does not estimate them here; estimate: refinement is for meshes by numbers, "
        "dual for any mesh",
        why);
  return cheap;
}

PathErrors report_errors(const Voice& voice, const SolveConfig& config,
                         const std::optional<Material>& material, const Run::Where& where, Run& run,
                         const StepRecord& last, const Recording& recording,
                         const RecoveredPath& recovered, bool resolved) {
  PathErrors found;
  const EstimateListener progress_of_other = [&](const Run& other, int n, int of) {
    return estimate_progress(voice, other, n, of);
  };
  try {
    if (config.estimate == EstimateBy::none) return found;
    if (config.estimate == EstimateBy::recovery)
      found = recovered.errors(last, valued(config, run.scene, run.mesh, last), resolved);
    else if (config.in_motion())
      found = impact_errors(config, material, where, recording.impact_summary(), recording.forces(),
                            progress_of_other);
    else
      found = estimated(config, material, where, run, last, recording.forces(), progress_of_other);
  } catch (const Failure& failure) {
    if (interrupted()) recording.stopped_in_estimate();
    if (failure.code() != Exit::not_converged) throw;
    voice.warn(fmt::format("errors are not estimated: {}", failure.what()));
  }
  // estimates by refinement are marked where they are made
  const bool asks = config.accuracy && config.accuracy->of && !by_refinement(config);
  if (asks && !found.at_end.empty())
    mark_asked(config, where, valued(config, run.scene, run.mesh, last), found.at_end);
  for (const ErrorEstimate& e : found.at_end) voice.detail("{}", in_words(e));
  for (const std::string& why : found.not_known) voice.warn(why);
  report_costs(voice, found);
  return found;
}

void report_results(const Voice& voice, const SolveConfig& config, const Run& run,
                    const StepRecord& last, const std::vector<ErrorEstimate>& estimates) {
  bool any = false;
  for (const ErrorEstimate& e : estimates) {
    if (!is_main_result(e)) continue;
    voice.brief(in_words(e));
    any = true;
  }
  // Without an estimate the numbers themselves; no detail has named them before.
  for (const Valued& one : valued_forces(step_forces(config, run.scene, run.mesh, last))) {
    if (!one.of_force() || has_estimate(estimates, one.name)) continue;
    if (any && config.in_motion()) continue;  // the force of an impact has been named
    if (one.name == "pull_off") continue;     // that of the end, and not the greatest
    const char* bar = is_given(config, one.name) ? "as given" : "no error bar";
    voice.say("{} {:.5g} {}, {}", one.name, one.value, one.unit, bar);
    any = true;
  }
  if (any) return;
  for (const ErrorEstimate& e : estimates) voice.brief(in_words(e));
}

std::vector<Summary> report_forecast(const Voice& voice, const SolveConfig& config,
                                     const std::optional<Material>& material,
                                     const Run::Where& where, Run& run, const RunWatch& watch,
                                     double spent, double finer) {
  const double estimate = finer + estimate_forecast(config, material, where, run);
  MeshChecks checks = forecast_of_mesh(run, watch.of_mesh(), config.stability);
  checks.signatures = watch.signatures_at_each_step();
  return dry_run(config, run.reduction.scene(), run.body, run.increment, checks, estimate, spent,
                 voice.quiet);
}

SolutionWriter::Histories histories_of(const PathErrors& estimate) {
  SolutionWriter::Histories histories;
  for (const auto& [force, errors] : estimate.along) histories[force + "_error"] = errors;
  for (const ErrorEstimate& e : estimate.at_end) {
    const auto limits = estimate.limits.find(e.of.name);
    if (!e.limit_answers || limits == estimate.limits.end()) continue;
    histories[e.of.name + "_limit_share"] = limits->second.shares;
    histories[e.of.name + "_error"] = limits->second.bars;
  }
  return histories;
}

}  // namespace langer
