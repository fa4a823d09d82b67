#include "accuracy/estimate/impact_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "accuracy/estimate/least_scatter.hpp"
#include "accuracy/estimate/observed_law.hpp"
#include "accuracy/estimate/refinements.hpp"
#include "scene/run/body_mesh.hpp"
#include "scene/run/impact_results.hpp"

namespace langer {

namespace {

using Find = std::function<Place(const std::string&)>;

constexpr std::array results_of_impact{"peak_force", "contact_time", "restitution"};

// The results of another scene, solved without a file.
std::vector<Summary> impact_of(const SolveConfig& config, const std::optional<Material>& material,
                               const Find& where,
                               const std::function<RunListener(const Run&)>& progress) {
  Run run(body_mesh(config, "", where), config, material, where);
  ImpactResults results(run.scene, run.inertia.get());
  RunListener listener = progress(run);
  const auto next = listener.of_whole;
  listener.of_whole = [&results, next](StepRecord& step, const SolveReport& report) {
    results.add(step);
    if (next) next(step, report);
  };
  need_the_end_of_other(run.follow(listener));
  return results.summary();
}

std::optional<double> value_of(const std::vector<Summary>& results, const std::string& name) {
  for (const Summary& one : results) {
    if (one.name == name) return one.value;
  }
  return std::nullopt;
}

// How many nodes touch where the force is largest.
double touching_at_peak(const std::vector<StepForces>& path) {
  return touching_at(path, "force", judged_at({}, path, "force"));
}

}  // namespace

bool is_of_impact(const std::string& quantity) {
  return std::ranges::find(results_of_impact, quantity) != results_of_impact.end();
}

PathErrors impact_errors(const SolveConfig& config, const std::optional<Material>& material,
                         const Find& where, const std::vector<Summary>& found,
                         const std::vector<StepForces>& path, const EstimateListener& listener) {
  const std::vector<LongerScene> scenes = longer_in_space_and_time(config, where);
  std::vector<double> length{1};
  std::vector<std::vector<Summary>> of_scenes{found};
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    length.push_back(scenes[i].length);
    of_scenes.push_back(impact_of(scenes[i].config, material, where, [&](const Run& run) {
      return listener(run, static_cast<int>(i) + 1, static_cast<int>(scenes.size()));
    }));
  }
  const bool section = config.mesh && is_section(config.mesh->geometry);
  const double touching = touching_at_peak(path);
  PathErrors out;
  for (const Summary& own : found) {
    if (!is_of_impact(own.name)) continue;
    std::vector<double> values;
    for (const std::vector<Summary>& results : of_scenes) {
      if (const auto value = value_of(results, own.name)) values.push_back(*value);
    }
    const auto law = observed_law(length, values, 2);
    if (!law) {
      out.not_known.push_back(
          fmt::format("the error of {} is not known: with longer elements and increments the path "
                      "ends in contact, or without one",
                      own.name));
      continue;
    }
    ErrorEstimate e{
        {own.name, own.unit, own.value}, own.value - law->limit, 0, law->scatter, 0, law->order};
    e.order_observed = law->order < 2;
    e.cells_with_increments = true;
    if (law->grows) {  // they show no limit: the largest difference says all that is known
      e.cells = 0;
      e.order = 2;
      e.order_observed = false;
      for (double value : values) e.scatter = std::max(e.scatter, std::abs(value - own.value));
    }
    e.scatter = std::max(e.scatter, 0.5 * one_by_one(touching, section) * std::abs(own.value));
    out.at_end.push_back(std::move(e));
  }
  return out;
}

}  // namespace langer
