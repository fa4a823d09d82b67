// langer-solve: equilibrium along a load path.
//   langer-solve indentation.yaml --mesh mesh.h5 --material material.h5 -o solution.h5
#include "base/memory.hpp"
#include "run/body_mesh.hpp"
#include "run/dry_run.hpp"
#include "run/error_estimate.hpp"
#include "run/run_words.hpp"
#include "run/step_record.hpp"
#include "stage.hpp"

namespace langer {
namespace {

// Nothing where a body that was solved at a point ceases to deform alike everywhere: its steps before are kept, to continue from.
std::optional<std::vector<Summary>> solve_by(const Job<SolveConfig>& job, bool at_a_point) {
  const double began = wall_seconds();
  SolveConfig config = job.config;
  const std::optional<Material> material =
      job.has("material") ? std::optional(material_of_body(job.input("material"))) : config.material;
  const std::optional<ChosenRung> rung = choose_accuracy(config, material);
  if (rung) job.say("accuracy: {}", rung->words);
  Run run(body_mesh(config, job.has("mesh") ? job.input("mesh") : "", job.where), config, material, job.where, at_a_point);
  const double jump = say_scene(job.voice(), run);
  RunWatch watch(run, config, job.where, job.has("material") ? study_from(job.input("material")) : StudyRecord{});
  if (job.dry_run)
    return dry_run(config, run.reduction.scene(), run.body, run.statics,
                   config.estimate == EstimateBy::refinement ? estimate_seconds(config, material, job.where) : 0, job.quiet);
  need_memory(run.statics, config.threads);
  const std::string loose = held_by_contact(run, job.where);
  Recording recording(run, watch, job.config, job.identity, job.output);
  Progress progress(job.voice(), run);
  if (!loose.empty()) job.say("{}: only contact holds it", loose);
  if (recording.with_other_settings())
    job.say("these steps were made with other settings: /provenance/earlier of the result holds them");

  const Interruptible at_the_end_of_a_step;
  const RunEnd end = recording.follow(progress);
  if (end.at == RunEnd::At::not_homogeneous) return std::nullopt;
  for (const std::string& line : watch.warnings()) job.warn("{}", line);
  if (end.path.complete)
    for (const std::string& line : watch.contact_warnings()) job.warn("{}", line);
  recording.need_the_end(end, loose);

  const std::vector<ErrorEstimate> errors = say_errors(job.voice(), config, material, job.where, run, end.last, recording);
  std::vector<Summary> said = summary_of(errors);  // of the result as a whole
  for (const Summary& s : watch.contact_summary()) said.push_back(s);
  // the processor's time before this function is that of loading the program
  recording.finish(
      recording.continues() ? std::nullopt : std::optional(Cost{cpu_seconds(), wall_seconds() - began, 1e-6 * peak_bytes()}), said);
  progress.finished(end.path, run.statics, recording.seconds());
  std::vector<Summary> summary = summary_of(run, end, recording.n_steps());
  if (rung) {
    const ReachedAccuracy found = reached(*rung, errors);
    if (!found.met) job.warn("accuracy: {}", found.words);
    summary.push_back({"accuracy", found.percent, "percent"});
  }
  summary.insert(summary.end(), said.begin(), said.end());
  summary.push_back({"fibre_jump", jump, "deg"});
  for (const Summary& s : watch.stability_summary()) summary.push_back(s);
  return summary;
}

std::vector<Summary> solve(const Job<SolveConfig>& job) {
  const SolveConfig& config = job.config;
  if (auto summary = solve_by(job, config.homogeneous == Homogeneous::automatic && config.stability == StabilityCheck::off))
    return *summary;
  job.say("homogeneous: the mesh no longer balances, and is solved from there on");
  return *solve_by(job, false);
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) { return langer::run_stage<langer::SolveConfig>(argc, argv, "solve", langer::solve); }
