// langer-solve: equilibrium along a load path.
//   langer-solve indentation.yaml --mesh mesh.h5 --material material.h5 -o solution.h5
#include <csignal>

#include "accuracy/estimate/say_errors.hpp"
#include "accuracy/refinement/model_choice.hpp"
#include "core/base/interrupt.hpp"
#include "identification/inverse/uncertainty.hpp"
#include "results/store/step_journal.hpp"
#include "scene/model/material_review.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/dry_run.hpp"
#include "scene/run/mirrored_solution.hpp"
#include "scene/run/run_words.hpp"
#include "scene/run/step_record.hpp"
#include "stage.hpp"

namespace langer {
namespace {

using Law = std::optional<Material>;

std::string one_rank(const Job<SolveConfig>& job) {
  if (ranks()) return why_one_rank(job.config, job.has("mirror") && !job.dry_run);
  return "";
}

void say_alone(const Job<SolveConfig>& job, const std::string& why) {
  job.say("{} of {} ranks have nothing to do: {}", ranks()->n() - 1, ranks()->n(), why);
}

// What the other ranks do while rank 0 speaks and writes.
std::vector<Summary> beside_first(Run& run, bool dry_run, const SolveConfig& config) {
  if (!run.shared_by()) return {};
  if (dry_run) {
    forecast_of(config, run.body, run.statics, run.scene.stops);
    return {};
  }
  on_root_rank(run.shared_by(), [] { return true; });
  run.resume_all();
  run.follow();
  return {};
}

// Nothing where another model is to be solved now.
std::optional<std::vector<Summary>> solve_by(const Job<SolveConfig>& job, const Law& material,
                                             const ParameterKnowledge& known, ModelChoice& model) {
  SolveConfig config = model.config();
  Run run(model.mesh(), config, material, job.where, model.at_a_point(), one_rank(job).empty());
  if (ranks() && !ranks()->first()) return beside_first(run, job.dry_run, config);
  if (!run.why_alone.empty()) say_alone(job, run.why_alone);
  const double jump = say_scene(job.voice(), run);
  config.estimate = estimate_of(job.voice(), config, material, job.where, run);
  RunWatch watch(run, config, job.where,
                 job.has("material") ? study_from(job.input("material")) : StudyRecord{});
  if (job.dry_run) return say_forecast(job.voice(), config, material, job.where, run, watch);
  RecoveredPath recovered(run, config, config.estimate == EstimateBy::recovery);
  std::string loose;
  std::optional<Sensitivity> sensitivity;
  std::optional<Uncertainty> uncertainty;
  std::optional<Recording> kept;
  on_root_rank(run.shared_by(), [&] {
    need_memory(run.statics, watch.of_mesh(), config.threads);
    loose = held_by_contact(run, job.where);
    sensitivity.emplace(run, config, job.where);
    uncertainty.emplace(known, run, *sensitivity);
    kept.emplace(run, watch, config, job.identity, job.output,
                 recovered.beside(uncertainty->beside(sensitivity->companion())));
    return true;
  });
  Recording& recording = *kept;
  run.resume_all();
  Progress progress(job.voice(), run);
  const Interruptible at_the_end_of_a_step;
  std::optional<EndsSoon> steps_are_kept(std::in_place, SIGINT);
  const RunEnd end = recording.follow(job.voice(), progress, loose);
  steps_are_kept.reset();
  if (end.at == RunEnd::At::not_homogeneous) {
    model.leave_point();
    return {};
  }
  std::optional<EndsSoon> all_is_kept(std::in_place);
  const PathErrors estimate = say_errors(job.voice(), config, material, job.where, run, end.last,
                                         recording, recovered, watch.contact_warnings().empty());
  const bool again = model.another(estimate, run.mesh);
  if (again && interrupted()) recording.stopped_in_estimate();
  if (again) return {};
  all_is_kept.reset();
  const auto forces = uncertainty->of(end.last);
  report_forces(job.voice(), known, forces, estimate.at_end);
  const auto said =
      joined({sensitivity->summary(end.last), summary_of(forces), summary_of(estimate.at_end),
              model.summary(estimate.at_end), watch.contact_summary()});
  recording.finish(said, histories_of(estimate));
  progress.finished(end.path, run.statics, recording.seconds());
  model.need(estimate.at_end, job.output);
  const std::vector<Summary> of_fibres{{"fibre_jump", jump, "deg"}};
  return joined(
      {summary_of(run, end, recording.n_steps()), said, of_fibres, watch.stability_summary()});
}

std::vector<Summary> solve(const Job<SolveConfig>& given) {
  Job<SolveConfig> job = given;
  std::optional<Interruptible> until_first_ends;
  if (ranks() && !ranks()->first()) until_first_ends.emplace();
  if (const std::string why = one_rank(job); !why.empty()) {
    if (!ranks()->first()) return {};
    say_alone(job, why);
  }
  std::string file;
  if (job.has("material")) file = job.input("material");
  std::string mesh;
  if (job.has("mesh")) mesh = job.input("mesh");
  Law material = job.config.material;
  if (job.has("material")) material = Law(material_of_body(file));
  for (const std::string& line : review_lines(job.config, material, job.where)) {
    job.voice().warn(line);
  }
  const ParameterKnowledge known = prepare_uncertainty(job.config, file, job.where);
  if (job.has("mirror") && !job.dry_run &&
      job.config.sensitivity.empty()) {  // a number of one is another of its image
    SolveConfig own = job.config;
    if (!mesh.empty()) own.mesh.reset();  // another mesh is solved
    const MirrorTask task{own,       material, job.where, job.identity, mesh, job.input("mirror"),
                          job.output};
    if (const auto image = take_image(job.voice(), task)) return *image;
  }
  ModelChoice model(job.voice(), job.config, mesh, material, job.where, job.dry_run);
  for (;;) {
    const bool at_a_point = model.at_a_point();
    try {
      if (const auto results = solve_by(job, material, known, model)) return *results;
    } catch (const Failure& failure) {
      if (!model.another(failure)) throw;
    }
    const bool goes_on =
        at_a_point && !model.at_a_point();  // the mesh, from the steps of the point
    if (!goes_on) discard_steps(job.output);
  }
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) {
  return langer::run_stage<langer::SolveConfig>(argc, argv, "solve", langer::solve);
}
