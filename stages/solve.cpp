// langer-solve: equilibrium along a load path.
//   langer-solve indentation.yaml --mesh mesh.h5 --material material.h5 -o solution.h5
#include "accuracy/accuracy.hpp"
#include "accuracy/say_errors.hpp"
#include "accuracy/section_in_place.hpp"
#include "inverse/uncertainty.hpp"
#include "mirror/mirror.hpp"
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
Solved solve_by(const Job<SolveConfig>& job, const Law& material, const ParameterKnowledge& known, SectionInPlace& section,
                Accuracy& accuracy, bool at_a_point) {
  const SolveConfig config = accuracy.config();
  Run run(body_mesh(config, job.has("mesh") ? job.input("mesh") : "", job.where), config, material, job.where, at_a_point);
  const double jump = say_scene(job.voice(), run);
  RunWatch watch(run, config, job.where, job.has("material") ? study_from(job.input("material")) : StudyRecord{});
  if (job.dry_run) return {.summary = say_forecast(job.voice(), config, material, job.where, run, watch)};
  need_memory(run.statics, watch.of_mesh(), config.threads);
  const std::string loose = held_by_contact(run, job.where);
  Sensitivity sensitivity(run, config, job.where);
  const Uncertainty uncertainty(known, run, sensitivity);
  Recording recording(run, watch, config, job.identity, job.output, uncertainty.beside(sensitivity.companion()));
  Progress progress(job.voice(), run);
  const Interruptible at_the_end_of_a_step;
  const RunEnd end = recording.follow(job.voice(), progress, loose);
  if (end.at == RunEnd::At::not_homogeneous) return {Solved::At::not_homogeneous};
  const PathErrors estimate = say_errors(job.voice(), config, material, job.where, run, end.last, recording);
  const auto& errors = estimate.at_end;
  if (!section.accurate(errors)) return {Solved::At::other_section};
  if (accuracy.refine(errors)) return {Solved::At::too_coarse};
  const auto forces = uncertainty.of(end.last);
  say_forces(job.voice(), known, forces, errors);
  const auto said = joined({sensitivity.summary(end.last), summary_of(forces), summary_of(errors), section.summary(errors),
                            accuracy.summary(errors), watch.contact_summary()});
  recording.finish(said, histories_of(estimate));
  progress.finished(end.path, run.statics, recording.seconds());
  const std::vector<Summary> of_path = summary_of(run, end, recording.n_steps()), of_fibres{{"fibre_jump", jump, "deg"}};
  return {Solved::At::the_end, joined({of_path, said, of_fibres, watch.stability_summary()}), errors};
}

// of the solution given as --mirror, where this one is its image
std::optional<std::vector<Summary>> copied(const Job<SolveConfig>& job, const SolveConfig& own, const Law& material) {
  if (!job.has("mirror") || job.dry_run || !job.config.sensitivity.empty()) return {};  // a number of one is another of its image
  const std::string of = job.input("mirror"), mesh = job.has("mesh") ? job.input("mesh") : "";
  const Mirrored image = mirrored({own, material, job.where, job.identity, mesh, of, job.output});
  if (image.words.empty()) {
    job.say("not the image of {}, which differs in: {}", of, image.why_not);
    return {};
  }
  job.say("{}: not solved again", image.words);
  return image.summary;
}

// What the fit behind --material does not know of its parameters; they are those of `sensitivity` then, beside those named there.
ParameterKnowledge take_uncertain(Job<SolveConfig>& job) {
  if (job.config.uncertainty.value_or(UncertaintyBy::none) == UncertaintyBy::none) return {};
  const bool file = job.has("material") && std::filesystem::path(job.input("material")).extension() == ".h5";
  const ParameterKnowledge known = file ? knowledge_of(read_material(job.input("material"))) : ParameterKnowledge{};
  if (known.names.empty())
    throw Failure(Exit::config, Error{job.where("uncertainty"), "uncertainty",
                                      "linear, without a fit that tells how well its parameters are known",
                                      "--material with a material.h5 of langer-fit that holds a covariance", ""});
  for (const std::string& key : known.keys)
    if (auto& list = job.config.sensitivity; std::find(list.begin(), list.end(), key) == list.end()) list.push_back(key);
  return known;
}

std::vector<Summary> solve(const Job<SolveConfig>& given) {
  Job<SolveConfig> job = given;
  const ParameterKnowledge known = take_uncertain(job);
  const Law material = job.has("material") ? Law(material_of_body(job.input("material"))) : job.config.material;
  SolveConfig own = job.config;
  if (job.has("mesh")) own.mesh.reset();  // another mesh is solved
  if (const auto image = copied(job, own, material)) return *image;
  SectionInPlace section(job.voice(), own, material, job.where, job.dry_run);
  const auto accuracy_of = [&] {
    return Accuracy(job.voice(), section.taken() ? section.config() : job.config, material, job.where, job.dry_run);
  };
  Accuracy accuracy = accuracy_of();
  bool at_a_point = job.config.homogeneous == Homogeneous::automatic;
  for (;;) {
    Solved solved{Solved::At::too_coarse};
    try {
      solved = solve_by(job, material, known, section, accuracy, at_a_point);
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
