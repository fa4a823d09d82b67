// langer-solve: equilibrium along a load path.
//   langer-solve indentation.yaml --mesh mesh.h5 --material material.h5 -o solution.h5
#include "accuracy/accuracy.hpp"
#include "accuracy/say_errors.hpp"
#include "accuracy/section_in_place.hpp"
#include "run/body_mesh.hpp"
#include "run/dry_run.hpp"
#include "run/run_words.hpp"
#include "run/step_record.hpp"
#include "stage.hpp"

namespace langer {
namespace {

using Law = std::optional<Material>;

struct Solved {
  enum class At { the_end, not_homogeneous, too_coarse, other_section } at = At::the_end;
  std::vector<Summary> summary = {};
  std::vector<ErrorEstimate> errors = {};
};

// Not homogeneous: a body that was solved at a point ceases to deform alike everywhere; its steps before are kept, to continue from.
// Too coarse, other section: accuracy, or what may stand for the block, has another config now.
Solved solve_by(const Job<SolveConfig>& job, const Law& material, SectionInPlace& section, Accuracy& accuracy, bool at_a_point) {
  const SolveConfig config = accuracy.config();
  Run run(body_mesh(config, job.has("mesh") ? job.input("mesh") : "", job.where), config, material, job.where, at_a_point);
  const double jump = say_scene(job.voice(), run);
  RunWatch watch(run, config, job.where, job.has("material") ? study_from(job.input("material")) : StudyRecord{});
  if (job.dry_run) return {.summary = say_forecast(job.voice(), config, material, job.where, run, watch)};
  need_memory(run.statics, watch.of_mesh(), config.threads);
  const std::string loose = held_by_contact(run, job.where);
  Recording recording(run, watch, config, job.identity, job.output);
  Progress progress(job.voice(), run);
  const Interruptible at_the_end_of_a_step;
  const RunEnd end = recording.follow(job.voice(), progress, loose);
  if (end.at == RunEnd::At::not_homogeneous) return {Solved::At::not_homogeneous};
  const PathErrors estimate = say_errors(job.voice(), config, material, job.where, run, end.last, recording);
  const auto& errors = estimate.at_end;
  if (!section.accurate(errors)) return {Solved::At::other_section};
  if (accuracy.refine(errors)) return {Solved::At::too_coarse};
  const auto said = joined({summary_of(errors), section.summary(errors), accuracy.summary(errors), watch.contact_summary()});
  recording.finish(said, histories_of(estimate));
  progress.finished(end.path, run.statics, recording.seconds());
  const std::vector<Summary> of_path = summary_of(run, end, recording.n_steps()), of_fibres{{"fibre_jump", jump, "deg"}};
  return {Solved::At::the_end, joined({of_path, said, of_fibres, watch.stability_summary()}), errors};
}

std::vector<Summary> solve(const Job<SolveConfig>& job) {
  const Law material = job.has("material") ? Law(material_of_body(job.input("material"))) : job.config.material;
  SolveConfig own = job.config;
  if (job.has("mesh")) own.mesh.reset();  // another mesh is solved
  SectionInPlace section(job.voice(), own, material, job.where, job.dry_run);
  const auto accuracy_of = [&] {
    return Accuracy(job.voice(), section.taken() ? section.config() : job.config, material, job.where, job.dry_run);
  };
  Accuracy accuracy = accuracy_of();
  bool at_a_point = job.config.homogeneous == Homogeneous::automatic;
  for (;;) {
    Solved solved{Solved::At::too_coarse};
    try {
      solved = solve_by(job, material, section, accuracy, at_a_point);
    } catch (const Failure& failure) {
      if (!accuracy.begin_anew(failure)) throw;
    }
    if (solved.at == Solved::At::not_homogeneous) {
      job.say("homogeneous: the mesh no longer balances, and is solved from there on");
      at_a_point = false;
    } else if (solved.at == Solved::At::other_section) {
      accuracy = accuracy_of();
    } else if (solved.at == Solved::At::the_end) {
      if (!job.dry_run) accuracy.need(solved.errors, job.output);
      return solved.summary;
    }
  }
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) { return langer::run_stage<langer::SolveConfig>(argc, argv, "solve", langer::solve); }
