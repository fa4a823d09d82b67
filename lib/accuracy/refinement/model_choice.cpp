#include "accuracy/refinement/model_choice.hpp"

#include <fmt/format.h>

#include <cmath>

#include "accuracy/refinement/constants.hpp"
#include "core/base/stopwatch.hpp"
#include "core/base/text.hpp"
#include "scene/run/body_mesh.hpp"
#include "scene/run/dry_run.hpp"
#include "scene/run/run_words.hpp"

namespace langer {

namespace {

// A mesh file replaces the geometry of the scene, so the choice of a section must not use it.
SolveConfig of_scene(SolveConfig config, const std::string& file) {
  if (!file.empty()) config.mesh.reset();
  return config;
}

}  // namespace

ModelChoice::ModelChoice(const Voice& voice, const SolveConfig& config, const std::string& file,
                         const std::optional<Material>& material, Where where, bool dry)
    : voice_(voice),
      asked_(config),
      file_(file),
      material_(material),
      where_(std::move(where)),
      dry_(dry),
      section_(voice, of_scene(config, file), material, where_, dry),
      accuracy_(of_model()),
      at_a_point_(config.homogeneous == Homogeneous::automatic && !config.modes &&
                  !config.harmonic) {}

Accuracy ModelChoice::of_model() const {
  return Accuracy(voice_, section_.taken() ? section_.config() : asked_, material_, where_, dry_);
}

// The mesh of the next computation: the cut cells of the last decision, or at first the mesh of the
// scene. Where cells may be cut, those under indenters are cut in advance, because an error
// estimate of a contact that a single cell resolves is not useful.
Mesh ModelChoice::mesh() {
  if (cells_) return cells_->mesh();
  std::vector<std::string> notes;
  Mesh mesh = body_mesh(config(), file_, where_, &notes);
  if (!file_was_read_) {
    for (const std::string& note : notes) voice_.say("{}", note);
  }
  file_was_read_ = true;
  if (!accuracy_.cuts() || !reason_not_refinable(mesh).empty()) return mesh;
  cells_.emplace(mesh);
  if (const int times = shorten_under(config(), *cells_); times > 0)
    voice_.say("accuracy: cells under the indenter are cut {} time{}: {} instead of {}", times,
               plural_s(times), cells_->mesh().n_cells(), mesh.n_cells());
  return cells_->mesh();
}

// What follows from the estimated errors of a computation. A section that is not accurate enough is
// replaced first, by a finer section or by the block. Then the cells are refined until the target
// is reached, the limits on size are reached, or a finer level is not better.
Decision ModelChoice::decide(const PathErrors& errors, const Mesh& mesh) {
  if (!section_.accurate(errors.at_end)) {
    before_.reset();
    accuracy_ = of_model();
    return {Decision::Action::refine};
  }
  if (is_last_) return accuracy_.final_decision(errors.at_end);
  std::optional<Level> here;
  const std::optional<double> percent = accuracy_.missed_percent(errors.at_end);
  // This level is kept as a place to return to, with its error, if the next one fails.
  if (!forces_judged(errors.at_end).empty()) here = Level{accuracy_, cells_, percent};
  Decision decision;
  // Errors without parts by cells can only refine everywhere; errors by cells cut where they are.
  if (errors.of_cells.empty()) {
    decision = accuracy_.decide(errors.at_end);
  } else if (cut(errors, mesh)) {
    decision = {Decision::Action::refine};
  } else {
    decision = accuracy_.final_decision(errors.at_end);
  }
  if (decision.action == Decision::Action::refine) {
    before_ = std::move(here);
    return decision;
  }

  // A finer level with a clearly larger error than the one before is discarded.
  const bool worse = percent && before_ && before_->percent &&
                     *before_->percent <= refinement::clearly_better * *percent;
  if (!worse) return decision;
  back_to_level_before(
      fmt::format("the error of a finer level is estimated at {:.2g} %, and {:.2g} % before",
                  *percent, *before_->percent));
  return {Decision::Action::refine};
}

// Solves the level before once more, now as the last: its decision is final whatever it finds.
void ModelChoice::back_to_level_before(const std::string& why) {
  voice_.say("accuracy: {}; again with the cells and increments of the level before", why);
  accuracy_ = before_->accuracy;
  cells_ = before_->cells;
  accuracy_.set_stop_reason(why);
  before_.reset();
  is_last_ = true;
}

// A failure of a finer level is no failure of the scene: the level before had an equilibrium.
// Faults of the input, in contrast, are passed on.
bool ModelChoice::retry_after(const Failure& failure) {
  if (accuracy_.retry_after(failure)) return true;
  if (!before_ || failure.code() != Exit::not_converged) return false;
  const std::string why =
      fmt::format("a next level found no equilibrium: {}", failure.errors().front().found);
  back_to_level_before(why);
  return true;
}

// Cuts the cells with the largest parts of the error. False, with a reason for the summary, where
// the mesh has no cuts, the number of cells would exceed its limit, or the next level would be too
// expensive. The mesh remains as it was in all these cases.
bool ModelChoice::cut(const PathErrors& errors, const Mesh& mesh) {
  const std::optional<double> wanted = accuracy_.wanted_share(errors.at_end);
  if (!wanted) return false;
  if (!cells_) {
    std::string reason = reason_not_refinable(config());
    if (reason.empty()) reason = reason_not_refinable(mesh);
    accuracy_.set_stop_reason("its cells are not cut: " + reason);
    return false;
  }
  const std::vector<ErrorEstimate> judged = forces_judged(errors.at_end);
  CutMesh next = *cells_;
  // With the order p of convergence, a cut divides the error of a cell by 2^p.
  double order = 2;
  if (!judged.empty()) order = judged.front().order;
  next.cut(largest_parts(errors.of_cells, refinement::target * *wanted, order));
  const int n = next.mesh().n_cells();
  const int before = mesh.n_cells();
  std::string why;
  if (n > refinement::most_cut) {
    why = fmt::format("a next level would have {} cells, of at most {}", n, refinement::most_cut);
  } else {
    why = accuracy_.reason_too_expensive(next.mesh());
  }
  if (!why.empty()) {
    accuracy_.set_stop_reason(why);
    return false;
  }
  cells_ = std::move(next);
  voice_.say(
      "accuracy: {} of {} cells are cut into eight, from which most of the error comes; again with {}",
      (n - before) / 7, before, n);
  return true;
}

std::optional<double> ModelChoice::wanted_share_on(Run& run) const {
  std::vector<StepForces> path;
  RunListener listener;
  listener.of_whole = [&](StepRecord& step, const SolveReport&) {
    append_step(path, step_forces(config(), run.scene, run.mesh, step));
  };
  try {
    const RunEnd end = run.follow(listener);
    if (end.at != RunEnd::At::the_end) return std::nullopt;
    const PathErrors errors = estimated(config(), material_, where_, run, end.last, path, {});
    return accuracy_.wanted_share(errors.at_end);
  } catch (const Failure& failure) {
    if (failure.code() != Exit::not_converged) throw;
    voice_.say("accuracy: finer meshes are not forecast: {}", failure.what());
    return std::nullopt;
  }
}

// The error of cut cells falls about as n^(-2/3) of their number n, each mesh has some 2.3 times
// the cells of the one before, and the time of a mesh grows as n^1.5 (pads: 34, 19, 11 and 6.7 %
// with 960, 1926, 5370 and 10795 cells).
double ModelChoice::seconds_of_cuts(Run& run) const {
  constexpr double quick = 20, order = 2.0 / 3, growth = 2.3, cost = 1.5;
  // One hexahedron that stands for the body has no error of cells.
  if (!cells_ || run.reduction.mesh_of_point()) return 0;
  const bool has_error = config().estimate == EstimateBy::dual;
  if (!has_error || forecast_of(config(), run.body, run.increment, run.scene).seconds() > quick) {
    voice_.say("accuracy: the time is that of the first mesh: finer ones are not forecast");
    return 0;
  }
  const double start = cpu_seconds();
  const std::optional<double> wanted = wanted_share_on(run);
  const double first = cpu_seconds() - start;
  double seconds = 0;
  if (!wanted || *wanted <= 0) return seconds;

  const double cells = run.mesh.n_cells();
  const double needed = std::min(cells * std::pow(refinement::target * *wanted, -1 / order),
                                 static_cast<double>(refinement::most_cut));
  voice_.detail("accuracy: about {:.0f} cells, from the error on the first {:.0f}", needed, cells);
  for (double n = needed; n > 1.2 * cells; n /= growth)
    seconds += first * std::pow(n / cells, cost);
  return seconds;
}

void ModelChoice::leave_homogeneous_point() {
  voice_.say("homogeneous: the mesh no longer balances, and is solved from there on");
  at_a_point_ = false;
}

void ModelChoice::name_answers(std::vector<ErrorEstimate>& errors) const {
  accuracy_.name_answers(errors);
}

std::vector<Summary> ModelChoice::summary(const std::vector<ErrorEstimate>& errors) const {
  return joined({section_.summary(errors), accuracy_.summary(errors)});
}

}  // namespace langer
