// langer-solve: equilibrium of a body along a load path.
//   langer-solve indentation.yaml --mesh mesh.h5 --material material.h5 -o solution.h5
//
// The stage builds a model from the config, follows the load path and estimates the discretisation
// error. If the config asks for an accuracy, it repeats the run with a finer model until the
// estimate meets the request. Several ranks can share a run: rank 0 alone prints and writes.
#include <csignal>

#include "accuracy/checks/branch.hpp"
#include "accuracy/estimate/report_errors.hpp"
#include "accuracy/refinement/model_choice.hpp"
#include "core/base/interrupt.hpp"
#include "core/base/stopwatch.hpp"
#include "core/hdf5/seal.hpp"
#include "identification/inverse/uncertainty.hpp"
#include "results/store/step_journal.hpp"
#include "scene/model/material_review.hpp"
#include "scene/model/scene_bodies.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/dry_run.hpp"
#include "scene/run/loaded_area.hpp"
#include "scene/run/mirrored_solution.hpp"
#include "scene/run/run_words.hpp"
#include "scene/run/step_record.hpp"
#include "scene/run/vibration.hpp"
#include "stage.hpp"

namespace langer {
namespace {

using Summaries = std::vector<Summary>;

// `failure` with what is known of the stability of the path until then.
FailedWork with_verdict(const Failure& failure, const RunWatch& watch, const Run& run,
                        int n_steps) {
  Summaries numbers{{"exit_code", static_cast<double>(failure.code()), "-"},
                    {"t", run.t(), "-"},
                    {"steps", static_cast<double>(n_steps), "-"}};
  for (const Summary& s : watch.stability_summary()) numbers.push_back(s);
  return {failure, {numbers, watch.texts()}};
}

// The inputs of the stage, read once for all models that are solved.
struct Case {
  Job<SolveConfig> job;
  std::string mesh_file;             // empty if the config describes the mesh
  std::optional<Material> material;  // of the bodies for which the config names none
  StudyRecord study;                 // range of the tests that the material was fitted to
  ParameterKnowledge parameters;     // covariance of the fitted parameters, if the config asks
};

Case read_case(const Job<SolveConfig>& job) {
  Case input;
  input.job = job;
  input.material = job.config.material;
  std::string material_file;
  if (job.has("mesh")) input.mesh_file = job.input("mesh");
  if (job.has("material")) {
    material_file = job.input("material");
    input.material = material_of_body(material_file);
  }
  for (const std::string& line : review_lines(job.config, input.material, job.where)) {
    job.voice().warn(line);
  }
  input.parameters = prepare_uncertainty(input.job.config, material_file, job.where);
  if (input.job.config.in_motion()) {
    // What judges equilibria has nothing to say of a motion.
    if (input.job.config.estimate != EstimateBy::refinement)
      input.job.config.estimate = EstimateBy::none;
    input.job.config.stability = StabilityCheck::off;
    input.job.config.homogeneous = Homogeneous::off;
  }
  if (job.has("material")) input.study = study_from(material_file);
  return input;
}

// Why a single rank solves this job, whatever its body. Empty if ranks may share it.
std::string idle_reason(const Job<SolveConfig>& job) {
  if (!ranks()) return "";
  return single_rank_reason(job.config, job.has("mirror") && !job.dry_run);
}

void report_idle_ranks(const Job<SolveConfig>& job, const std::string& reason) {
  job.say("{} of {} ranks idle: {}", ranks()->n() - 1, ranks()->n(), reason);
}

// The solution of another member of a sweep, if this scene is its mirror image. Sensitivities are
// not copied: a number of one scene may be a different number of its image.
std::optional<Summaries> reuse_mirrored_solution(const Case& input) {
  const Job<SolveConfig>& job = input.job;
  if (!job.has("mirror") || job.dry_run || !job.config.sensitivity.empty()) return std::nullopt;
  if (job.config.dynamics) return std::nullopt;  // modes and harmonic need it, too
  SolveConfig config = job.config;
  if (!input.mesh_file.empty()) config.mesh.reset();  // the file replaces the config's mesh
  const MirrorTask task{config,          input.material,      job.where, job.identity,
                        input.mesh_file, job.input("mirror"), job.output};
  return copy_mirrored_solution(job.voice(), task);
}

// The part of a worker rank in a shared run: it follows the same path and neither prints nor
// writes. Its calls to other ranks match those of rank 0 in solve_model, in the same order.
void run_worker_rank(Run& run, bool dry_run, const SolveConfig& config) {
  if (!run.shared_by()) return;
  if (dry_run) {
    forecast_of(config, run.body, run.increment, run.scene);
    return;
  }
  on_root_rank(run.shared_by(), [] { return true; });  // the preparation of rank 0
  run.resume_all();
  run.follow();
}

// What is computed along the path and recorded with it. The order of the members is that of their
// construction: each refers to those above it.
struct Observers {
  RecoveredPath recovered;  // error estimate by recovery
  std::string loose;        // motions that only contact resists, in words
  std::optional<Sensitivity> sensitivity;
  std::optional<Uncertainty> uncertainty;
  std::optional<Recording> recording;  // writes the solution file

  Observers(const Run& run, const SolveConfig& config, std::string only_by_contact)
      : recovered(run, config, config.estimate == EstimateBy::recovery),
        loose(std::move(only_by_contact)) {}

  // Checks the memory and opens the output. Only rank 0 does so; if it fails, all ranks end.
  void prepare(const Case& input, const SolveConfig& config, Run& run, RunWatch& watch) {
    const Job<SolveConfig>& job = input.job;
    on_root_rank(run.shared_by(), [&] {
      check_memory(run.increment, watch.of_mesh(), config.threads);
      sensitivity.emplace(run, config, job.where);
      uncertainty.emplace(input.parameters, run, *sensitivity);
      recording.emplace(run, watch, config, job.identity, job.output,
                        recovered.beside(uncertainty->beside(sensitivity->observer())));
      return true;
    });
  }
};

// Follows the load path to its end. A signal is noted and ends the run after the current
// increment; the steps so far stay in the output, so that the next call continues from them.
RunEnd follow_load_path(const Job<SolveConfig>& job, Observers& observers, Progress& progress) {
  const EndsSoon steps_are_kept(SIGINT);
  return observers.recording->follow(job.voice(), progress, observers.loose);
}

// Vibrations about the state at the end of the path, in the solution and as tables beside it.
Summaries add_vibration(const Job<SolveConfig>& job, const SolveConfig& config, Run& run,
                        Observers& observers) {
  const auto add_derivatives = [&](const Modes& modes, const std::vector<double>& density,
                                   ModesRecord& record) {
    observers.sensitivity->add_frequencies(modes, density, record);
  };
  const auto vibration = vibration_of(config, run, job.where, add_derivatives);
  if (!vibration) return {};
  observers.recording->write_vibration(*vibration);
  for (const std::string& line : in_words(*vibration, run)) job.say("{}", line);
  if (vibration->modes)
    write_text_file(job.side_file("modes.csv"), csv(columns_of(*vibration->modes)));
  if (vibration->harmonic)
    write_text_file(job.side_file("harmonic.csv"), csv(columns_of(*vibration->harmonic)));
  return summary_of(*vibration);
}

// Solves the current model. Returns its results, or nothing if another model has to be solved.
std::optional<StageResults> solve_model(const Case& input, ModelChoice& model) {
  const Job<SolveConfig>& job = input.job;
  SolveConfig config = model.config();
  Mesh mesh = model.mesh();
  std::optional<Branch> branch;
  if (config.imperfection && !job.dry_run)
    mesh = imperfect_mesh(job.voice(), std::move(mesh), config, input.material, job.where);
  if (config.branch && !job.dry_run)
    branch = branch_of(job.voice(), mesh, config, input.material, job.where);
  Run run(std::move(mesh), config, input.material, job.where, model.at_a_point(),
          idle_reason(job).empty());
  if (branch) run.switch_branch(branch->at);
  if (ranks() && !ranks()->first()) {
    run_worker_rank(run, job.dry_run, config);
    return StageResults{};
  }
  if (!run.serial_reason.empty()) report_idle_ranks(job, run.serial_reason);

  check_vibration(config, run, job.where);
  const double fibre_jump = report_scene(job.voice(), run);
  for (const std::string& line : loads_on_other_areas(config, run.mesh)) job.warn("{}", line);
  std::string loose = held_by_contact(job.voice(), run, job.where);
  config.estimate = estimate_of(job.voice(), config, input.material, job.where, run);
  RunWatch watch(run, config, job.where, input.study);
  if (branch) watch.know(branch->bifurcation);
  if (job.dry_run) {
    const double spent = cpu_seconds() - model.seconds_of_forecasts();
    return report_forecast(job.voice(), config, input.material, job.where, run, watch, spent,
                           model.seconds_of_cuts(run));
  }

  Observers observers(run, config, std::move(loose));
  observers.prepare(input, config, run, watch);
  run.resume_all();
  Progress progress(job.voice(), run);
  const Interruptible signals_are_noted;
  RunEnd end;
  try {
    end = follow_load_path(job, observers, progress);
  } catch (const Failure& failure) {
    throw with_verdict(failure, watch, run, observers.recording->n_steps());
  }
  if (end.at == RunEnd::At::not_homogeneous) {
    model.leave_homogeneous_point();
    return std::nullopt;
  }

  // All steps are in the file now: a signal ends the program during the estimate at once.
  std::optional<EndsSoon> during_estimate(std::in_place);
  Recording& recording = *observers.recording;
  PathErrors errors =
      report_errors(job.voice(), config, input.material, job.where, run, end.last, recording,
                    observers.recovered, watch.contact_warnings().empty());
  model.solves_part(run.share_of_cells());
  const Decision decision = model.decide(errors, run.mesh);
  if (decision.action == Decision::Action::refine) {
    if (interrupted()) recording.stopped_in_estimate();
    return std::nullopt;
  }
  model.name_answers(errors.at_end);
  const Summaries of_vibration = add_vibration(job, config, run, observers);
  during_estimate.reset();

  const auto forces = observers.uncertainty->of(end.last);
  report_forces(job.voice(), input.parameters, forces, errors.at_end);
  const Summaries results =
      joined({observers.sensitivity->summary(end.last), summary_of(forces),
              summary_of(errors.at_end), model.summary(errors.at_end), watch.contact_summary(),
              of_vibration, recording.impact_summary()});
  recording.finish(results, histories_of(errors));
  progress.finished(end.path, run.increment, recording.seconds());
  // Forces with the deviation of the parameters have been named with their error bars.
  if (forces.empty()) report_results(job.voice(), config, run, end.last, errors.at_end);

  // The result is kept even if it is less accurate than requested; the exit code shows it.
  const Summaries of_fibres{{"fibre_jump", fibre_jump, "deg"}};
  const Summaries of_run = with_answers(summary_of(run, end, recording.n_steps()), errors);
  const StageResults all(joined({of_run, results, of_fibres, watch.stability_summary()}),
                         watch.texts());
  try {
    if (decision.action == Decision::Action::stop)
      model.require_accuracy(errors.at_end, job.output);
  } catch (const Failure& failure) {
    throw FailedWork(failure, all);
  }
  return all;
}

StageResults solve(const Job<SolveConfig>& given) {
  Job<SolveConfig> job = given;
  if (job.dry_run) job.verbose = true;  // asked what it would do, it says all of it
  expand_bodies(job.config, job.where.tree);
  // A worker rank notes a signal and waits for rank 0, which ends the run for all.
  std::optional<Interruptible> worker_signals;
  if (ranks() && !ranks()->first()) worker_signals.emplace();
  if (const std::string reason = idle_reason(job); !reason.empty()) {
    if (!ranks()->first()) return {};
    report_idle_ranks(job, reason);
  }

  const Case input = read_case(job);
  if (const auto copy = reuse_mirrored_solution(input)) return {*copy};

  ModelChoice model(job.voice(), input.job.config, input.mesh_file, input.material, job.where,
                    job.dry_run);
  while (true) {
    const bool was_homogeneous = model.at_a_point();
    try {
      if (const auto results = solve_model(input, model)) return *results;
    } catch (const Failure& failure) {
      if (!model.retry_after(failure)) throw;
    }
    // A body that has ceased to deform homogeneously continues on its mesh from the same steps.
    const bool continues = was_homogeneous && !model.at_a_point();
    if (!continues) discard_steps(job.output);
  }
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) {
  return langer::run_stage<langer::SolveConfig>(argc, argv, "solve", langer::solve,
                                                langer::vibration_files);
}
