// langer-solve: equilibrium along a load path.
//   langer-solve indentation.yaml --mesh mesh.h5 --material material.h5 -o solution.h5
#include <csignal>

#include "accuracy/model_choice.hpp"
#include "accuracy/say_errors.hpp"
#include "base/interrupt.hpp"
#include "inverse/uncertainty.hpp"
#include "mirror/mirror.hpp"
#include "run/dry_run.hpp"
#include "run/run_words.hpp"
#include "run/step_record.hpp"
#include "scene/config_io.hpp"
#include "stage.hpp"

namespace langer {
namespace {

using Law = std::optional<Material>;

// Nothing where another model is to be solved now.
std::optional<std::vector<Summary>> solve_by(const Job<SolveConfig>& job, const Law& material, const ParameterKnowledge& known,
                                             ModelChoice& model) {
  SolveConfig config = model.config();
  Run run(model.mesh(), config, material, job.where, model.at_a_point());
  const double jump = say_scene(job.voice(), run);
  config.estimate = estimate_of(job.voice(), config, material, job.where, run);
  RunWatch watch(run, config, job.where, job.has("material") ? study_from(job.input("material")) : StudyRecord{});
  if (job.dry_run) return say_forecast(job.voice(), config, material, job.where, run, watch);
  need_memory(run.statics, watch.of_mesh(), config.threads);
  const std::string loose = held_by_contact(run, job.where);
  Sensitivity sensitivity(run, config, job.where);
  const Uncertainty uncertainty(known, run, sensitivity);
  RecoveredPath recovered(run, config, config.estimate == EstimateBy::recovery);
  Recording recording(run, watch, config, job.identity, job.output, recovered.beside(uncertainty.beside(sensitivity.companion())));
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
  const PathErrors estimate = say_errors(job.voice(), config, material, job.where, run, end.last, recording, recovered);
  const bool again = model.another(estimate, run.mesh);
  if (again && interrupted()) recording.stopped_in_estimate();
  if (again) return {};
  all_is_kept.reset();
  const auto forces = uncertainty.of(end.last);
  say_forces(job.voice(), known, forces, estimate.at_end);
  const auto said = joined({sensitivity.summary(end.last), summary_of(forces), summary_of(estimate.at_end),
                            model.summary(estimate.at_end), watch.contact_summary()});
  recording.finish(said, histories_of(estimate));
  progress.finished(end.path, run.statics, recording.seconds());
  model.need(estimate.at_end, job.output);
  const std::vector<Summary> of_fibres{{"fibre_jump", jump, "deg"}};
  return joined({summary_of(run, end, recording.n_steps()), said, of_fibres, watch.stability_summary()});
}

std::vector<Summary> solve(const Job<SolveConfig>& given) {
  Job<SolveConfig> job = given;
  const std::string file = job.has("material") ? job.input("material") : "", mesh = job.has("mesh") ? job.input("mesh") : "";
  const Law material = job.has("material") ? Law(material_of_body(file)) : job.config.material;
  const ParameterKnowledge known = take_uncertain(job.config, file, job.where);
  if (job.has("mirror") && !job.dry_run && job.config.sensitivity.empty()) {  // a number of one is another of its image
    SolveConfig own = job.config;
    if (!mesh.empty()) own.mesh.reset();  // another mesh is solved
    const MirrorTask task{own, material, job.where, job.identity, mesh, job.input("mirror"), job.output};
    if (const auto image = take_image(job.voice(), task)) return *image;
  }
  ModelChoice model(job.voice(), job.config, mesh, material, job.where, job.dry_run);
  for (;;) {
    try {
      if (const auto results = solve_by(job, material, known, model)) return *results;
    } catch (const Failure& failure) {
      if (!model.another(failure)) throw;
    }
  }
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) { return langer::run_stage<langer::SolveConfig>(argc, argv, "solve", langer::solve); }
