#include "accuracy/checks/run_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/run/step_record.hpp"

namespace langer {

namespace {

// Movements that break the symmetry of a reduced body are checked at each step only where that is
// asked for, or no indenter is: a body between supports buckles so, one under an indenter rarely
// does, and its steps take few factorizations.
bool breaking_at_each_step(const Run& run, const SolveConfig& config) {
  return config.stability == StabilityCheck::each_step || config.on_unstable == OnUnstable::stop ||
         run.scene.contacts.empty();
}

StabilityWatch::Reach reach_of(const Run& run, const SolveConfig& config) {
  if (run.reduction.kind() == Reduction::Kind::section) return StabilityWatch::Reach::section;
  const bool each_step = breaking_at_each_step(run, config) && !run.body.division();
  if (run.reduction.kind() != Reduction::Kind::symmetry) return StabilityWatch::Reach::whole_body;
  return each_step ? StabilityWatch::Reach::whole_of_reduced
                   : StabilityWatch::Reach::symmetric_until_the_end;
}

}  // namespace

RunWatch::RunWatch(Run& run, const SolveConfig& config, const Run::Where& where, StudyRecord tests)
    : run_(run),
      asked_{config.stability, config.critical, config.on_unstable,
             breaking_at_each_step(run, config)},
      stability_(std::move(tests), reach_of(run, config)),
      result_(run.body),
      search_(run) {
  if (!run.scene.contacts.empty()) contact_.emplace(run.mesh, run.scene, where);
  if (Assembler* mesh = run.reduction.mesh_of_point(); mesh && asked_.when != StabilityCheck::off) {
    IncrementOptions options;
    options.threads = config.blas_threads;
    options.signs_from_cells = true;  // the elements of a homogeneous body deform alike
    mesh_.emplace(*mesh, std::vector<RigidContact>{}, options);
  }
}

// Whether states are kept to search between them: elastic bodies, whose states do not depend on how
// they were reached, and whose tangent is factorized.
bool RunWatch::follows_states() const {
  return asked_.locate == LocateCritical::automatic && asked_.when != StabilityCheck::off &&
         asked_.when != StabilityCheck::last && !mesh_ && !run_.body.viscous() &&
         run_.increment.bonds().none() && !run_.increment.iterative() && !run_.body.division();
}

// state: of an elastic body; else nullptr
void RunWatch::take_losses(const StepRecord& record, const BodyState* state) {
  const bool off = asked_.locate == LocateCritical::off || asked_.when == StabilityCheck::off;
  const bool looked_at = state && !off && !mesh_ && !run_.body.viscous() && !run_.body.division() &&
                         run_.scene.surfaces.empty();
  if (looked_at) losses_.take_surface(record, *state, run_);
  losses_.take(record);
}

void RunWatch::locate(const RunEnd& end, bool only_contact) {
  if (critical() || asked_.locate == LocateCritical::off || asked_.when == StabilityCheck::off)
    return;
  if (only_contact) {
    if (auto lost = losses_.support(end, run_.path.smallest)) {
      know(std::move(*lost));
      return;
    }
  }
  if (follows_states()) {
    const bool breaking = breaking_at(false) && run_.reduction.kind() == Reduction::Kind::symmetry;
    search_.search_bifurcation(end, breaking);
  }
  search_.search_jump();
  // Verdicts that need no search are known to an increment, which a point in the same one beats.
  for (const auto& lost : {losses_.material(), losses_.surface(), losses_.stability()}) {
    const bool first = lost && (!critical() || lost->t < critical()->t);
    if (first && !(lost->kind == "loss of stability" && !turning_.found().empty())) know(*lost);
  }
}

void RunWatch::kept(const StepRecord& step) {
  turning_.take(step, run_.scene.stops);
  if (const auto found = step.scalars.find("negative_eigenvalues");
      found != step.scalars.end() && follows_states()) {
    const int negative = static_cast<int>(std::abs(found->second));
    search_.take({step.t, run_.state_from(step), negative}, true);
  }
  if (!mesh_ && !run_.body.viscous()) {
    const BodyState state = run_.state_from(step);
    take_losses(step, &state);
  } else {
    take_losses(step, nullptr);
  }
  stability_.resume(step);
  if (contact_) contact_->kept(step);
  if (const auto found = step.scalars.find("shear_stiffness_min"); found != step.scalars.end()) {
    if (found->second < 0) {
      last_said_ = fmt::format(
          "strong ellipticity is lost (minimum acoustic eigenvalue {:.3g} MPa)", found->second);
    } else {
      last_said_ = "";
    }
  }
}

bool RunWatch::breaking_at(bool at_end) const {
  if (run_.body.division() || run_.increment.iterative())
    return false;  // no factor that shows signs
  if (at_end) return true;
  return asked_.breaking_at_each_step;
}

int RunWatch::signatures_at_each_step() const {
  const bool at_the_end = asked_.when == StabilityCheck::off || asked_.when == StabilityCheck::last;
  if (mesh_ || at_the_end || !breaking_at(false)) return 0;
  const int breaking = SymmetryBreaking::factors_of_stable(run_.reduction.symmetry_breaking_dofs());
  return breaking > 0 ? 1 + breaking : 0;
}

std::optional<StabilityReport> RunWatch::report_of(const StepRecord& record) {
  if (mesh_) return report_of_point(record);
  // Where not every step is checked for all movements, the last tangent of the increment tells
  // enough of the others: extrapolation has put it near the state.
  const bool thoroughly = breaking_at(at_end_of_path(record.t));
  double within = 0.5;
  if (thoroughly) within = TangentSigns::nearly_there;
  StabilityReport report = stability_.look(run_.body, run_.increment, within);
  report.t = record.t;  // not that of the loads, where their factor is a result
  if (!thoroughly) return report;
  if (!breaking_) {
    std::vector<Dofs> kinds = run_.reduction.symmetry_breaking_dofs();
    if (kinds.empty()) return report;
    breaking_.emplace(run_.body, std::move(kinds));
  }
  report.breaking = breaking_->signature(run_.increment);
  return report;
}

// A homogeneous body is solved on one hexahedron, but its stability is that of the mesh.
std::optional<StabilityReport> RunWatch::report_of_point(const StepRecord& record) {
  const std::optional<StepRecord> whole = run_.reduction.whole(record);
  if (!whole) return std::nullopt;
  mesh_->restore(state_of(*whole, run_.scene));
  return stability_.look(*run_.reduction.mesh_of_point(), *mesh_);
}

bool RunWatch::of_part(StepRecord& record) {
  turning_.take(record, run_.scene.stops);
  const bool at_end = at_end_of_path(record.t);
  if (asked_.when == StabilityCheck::off || (asked_.when == StabilityCheck::last && !at_end))
    return true;
  const std::optional<StabilityReport> report = report_of(record);
  if (!report) return true;
  if (follows_states() && report->signature) {
    // where movements that break the symmetry are looked at in the last step only, they are no
    // change from the step before
    int negative = std::abs(report->signature->negative);
    if (report->breaking && breaking_at(false)) negative += std::abs(report->breaking->negative);
    const bool doubtful = run_.increment.n_indefinite() > n_indefinite_;
    n_indefinite_ = run_.increment.n_indefinite();
    search_.take({record.t, run_.increment.accepted(), negative}, doubtful);
  }
  if (asked_.on_unstable == OnUnstable::stop && !critical()) search_.search_jump();
  stability_.keep(*report);
  if (asked_.when != StabilityCheck::last) stability_.add_to(record, *report);
  take_losses(record, &run_.increment.accepted());
  last_said_ = in_words(*report);
  if (asked_.on_unstable != OnUnstable::stop) return true;
  if (search_.jumped()) last_said_ = "reached by a jump past a limit point";
  if (last_said_.empty()) return true;
  unstable_ = fmt::format("unstable at t = {:.6g}: {}", record.t, last_said_);
  return false;
}

std::optional<Error> RunWatch::of_whole(StepRecord& record, const SolveReport& report) {
  if (contact_) contact_->look(record);
  result_.look(record.t, run_.increment.accepted().u, report);
  return result_.refusal();
}

std::vector<std::string> RunWatch::warnings() const {
  std::vector<std::string> lines = stability_.warnings();
  if (critical()) lines.push_back("first critical point: " + critical()->words());
  if (search_.jumped() && critical()) lines.push_back(search_.jump_in_words());
  for (const TurningPoint& point : turning_.found()) lines.push_back(point.words());
  if (run_.increment.gave_up_iterating())
    lines.push_back(
        "iterative solutions of the tangent did not converge: it was factorized in those increments (solver.newton.linear)");
  for (std::string& line : result_.warnings()) lines.push_back(std::move(line));
  return lines;
}

std::vector<std::string> RunWatch::notes() const { return stability_.notes(); }

std::vector<std::string> RunWatch::contact_warnings() const {
  if (!contact_) return {};
  contact_->finish();
  return contact_->warnings();
}

std::vector<Summary> RunWatch::contact_summary() const {
  if (contact_) return contact_->summary();
  return std::vector<Summary>{};
}

std::vector<Summary> RunWatch::stability_summary() const {
  if (asked_.when == StabilityCheck::off) return std::vector<Summary>{};
  std::vector<Summary> all = stability_.summary();
  if (critical()) {
    all.push_back({"critical_t", critical()->t, "-"});
    all.push_back({"critical_load_factor", critical()->load_factor, "-"});
    if (critical()->angle) all.push_back({"critical_wave_angle", *critical()->angle, "deg"});
  } else if (!turning_.found().empty()) {
    all.push_back({"critical_t", turning_.found().front().t, "-"});
  }
  return all;
}

std::vector<TextResult> RunWatch::texts() const {
  if (asked_.when == StabilityCheck::off) return {};
  if (critical())
    return {{"critical_kind", critical()->kind}, {"critical_symmetry", critical()->symmetry}};
  if (!turning_.found().empty()) return {{"critical_kind", "limit point of load"}};
  return {};
}

}  // namespace langer
