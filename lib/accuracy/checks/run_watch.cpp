#include "accuracy/checks/run_watch.hpp"

#include <fmt/format.h>

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
      when_(config.stability),
      on_unstable_(config.on_unstable),
      breaking_at_each_step_(breaking_at_each_step(run, config)),
      stability_(std::move(tests), reach_of(run, config)),
      result_(run.body) {
  if (!run.scene.contacts.empty()) contact_.emplace(run.mesh, run.scene, where);
  if (Assembler* mesh = run.reduction.mesh_of_point(); mesh && when_ != StabilityCheck::off) {
    StaticsOptions options;
    options.threads = config.blas_threads;
    options.signs_from_cells = true;  // the elements of a homogeneous body deform alike
    mesh_.emplace(*mesh, std::vector<RigidContact>{}, options);
  }
}

void RunWatch::kept(const StepRecord& step) {
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
  if (run_.body.division() || run_.statics.iterative()) return false;  // no factor that shows signs
  if (at_end) return true;
  return breaking_at_each_step_;
}

std::optional<StabilityReport> RunWatch::report_of(const StepRecord& record) {
  if (mesh_) return report_of_point(record);
  StabilityReport report = stability_.look(run_.body, run_.statics);
  if (!breaking_at(at_end_of_path(record.t))) return report;
  if (!breaking_) {
    std::vector<Dofs> kinds = run_.reduction.symmetry_breaking_dofs();
    if (kinds.empty()) return report;
    breaking_.emplace(run_.body, std::move(kinds));
  }
  report.breaking = breaking_->signature(run_.statics);
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
  const bool at_end = at_end_of_path(record.t);
  if (when_ == StabilityCheck::off || (when_ == StabilityCheck::last && !at_end)) return true;
  const std::optional<StabilityReport> report = report_of(record);
  if (!report) return true;
  stability_.keep(*report);
  if (when_ != StabilityCheck::last) stability_.add_to(record, *report);
  last_said_ = in_words(*report);
  if (last_said_.empty() || on_unstable_ != OnUnstable::stop) return true;
  unstable_ = fmt::format("unstable at t = {:.6g}: {}", record.t, last_said_);
  return false;
}

std::optional<Error> RunWatch::of_whole(StepRecord& record, const SolveReport& report) {
  if (contact_) contact_->look(record);
  result_.look(record.t, run_.statics.accepted().u, report);
  return result_.refusal();
}

std::vector<std::string> RunWatch::warnings() const {
  std::vector<std::string> lines = stability_.warnings();
  if (run_.statics.gave_up_iterating())
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
  if (when_ == StabilityCheck::off) return std::vector<Summary>{};
  return stability_.summary();
}

}  // namespace langer
