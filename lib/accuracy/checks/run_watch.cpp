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
      when_(config.stability),
      on_unstable_(config.on_unstable),
      breaking_at_each_step_(breaking_at_each_step(run, config)),
      stability_(std::move(tests), reach_of(run, config)),
      result_(run.body),
      locate_(config.critical) {
  if (!run.scene.contacts.empty()) contact_.emplace(run.mesh, run.scene, where);
  if (Assembler* mesh = run.reduction.mesh_of_point(); mesh && when_ != StabilityCheck::off) {
    StaticsOptions options;
    options.threads = config.blas_threads;
    options.signs_from_cells = true;  // the elements of a homogeneous body deform alike
    mesh_.emplace(*mesh, std::vector<RigidContact>{}, options);
  }
}

// Whether states are kept to search between them: elastic bodies, whose states do not depend on how
// they were reached, and whose tangent is factorized.
bool RunWatch::follows_states() const {
  return locate_ == LocateCritical::automatic && when_ != StabilityCheck::off &&
         when_ != StabilityCheck::last && !mesh_ && !run_.body.viscous() &&
         run_.statics.bonds().none() && !run_.statics.iterative() && !run_.body.division();
}

// An increment may pass a limit point: Newton's method then finds a distant state, which may well
// be stable. It shows in a movement much faster than before. Where all tangents of its iterations
// were positive definite it takes more to suspect a jump, as most bodies soften or stiffen on their
// way. Contact that opens or closes and a kink of a given history change the rate by themselves.
void RunWatch::take_jump(const StateOnPath& state, bool doubtful) {
  constexpr std::size_t most = 4;  // suspects kept: those whose movement grew most
  if (!run_.scene.contacts.empty() || run_.path.arc_length) return;
  const bool first_increment = !(before_->t < last_->t);
  double faster = INFINITY;
  if (first_increment) {
    if (!doubtful) return;
  } else {
    const auto rate = [](const StateOnPath& a, const StateOnPath& b) {
      return (b.state.u - a.state.u).norm() / (b.t - a.t);
    };
    faster = rate(*last_, state) / rate(*before_, *last_);
    const bool kink = kink_between(before_->t, state.t);
    const double suspect = doubtful ? 1.5 : 3.0;
    if (!(faster > suspect) || (kink && !doubtful)) return;
  }
  suspects_.push_back({Crossing{*before_, *last_, state}, faster});
  if (suspects_.size() <= most) return;
  const auto slower = [](const Suspect& a, const Suspect& b) {
    return a.faster < b.faster;
  };
  suspects_.erase(std::min_element(suspects_.begin(), suspects_.end(), slower));
}

// doubtful: tangents of the increment were not positive definite, or nothing is known of them
void RunWatch::take_state(StateOnPath state, bool doubtful) {
  if (crossing_) return;
  if (!last_) {
    last_ = StateOnPath{0, at_rest(state.state), 0};
    before_ = last_;
  }
  take_jump(state, doubtful);
  if (state.negative > last_->negative) {
    crossing_ = Crossing{*before_, *last_, std::move(state)};
    return;
  }
  before_ = std::move(last_);
  last_ = std::move(state);
}

// Whether the scene itself turns around there: at a kink of a given history.
bool RunWatch::kink_between(double from, double to) const {
  const std::vector<double>& kinks = run_.scene.stops;
  return std::any_of(kinks.begin(), kinks.end(), [&](double t) { return from < t && t < to; });
}

// An extremum lies between the first and the last of three steps if the one between them is the
// greatest or the least: that of the parabola through them. Where a given history has a kink, the
// extremum is that of the history and no limit point.
void RunWatch::take_turning(const StepRecord& record) {
  for (const auto& [name, value] : record.scalars) {
    if (name != "load_factor" && !name.starts_with("load_pressure")) continue;
    std::vector<Sample>& known = samples_[name];
    if (known.empty()) known.push_back({0, 0});
    if (known.size() == 2) {
      const Sample a = known[0];
      const Sample b = known[1];
      const double left = (b.value - a.value) / (b.t - a.t);
      const double right = (value - b.value) / (record.t - b.t);
      if (left * right < 0 && !kink_between(a.t, record.t)) {
        const double curvature = (right - left) / (record.t - a.t);
        const double slope = left + curvature * (b.t - a.t);
        const double t = b.t - 0.5 * slope / curvature;
        const double there = b.value + slope * (t - b.t) + curvature * (t - b.t) * (t - b.t);
        const char* unit = name == "load_factor" ? "" : " MPa";
        turnings_.push_back({name, unit, t, there, left > 0});
      }
      known.erase(known.begin());
    }
    known.push_back({record.t, value});
  }
}

// Where the line between two values, the second of which is negative, is 0. The load factor moves
// with t where it is t.
void RunWatch::move_to_root(CriticalPoint& point, const std::optional<Sample>& before,
                            const Sample& now) {
  if (!before || !(before->value > 0) || !std::isfinite(now.value)) return;
  const bool same = point.load_factor == point.t;
  point.t -= (now.t - before->t) * now.value / (now.value - before->value);
  if (same) point.load_factor = point.t;
}

// The first step in which a point of the body has lost strong ellipticity, and the first that is
// unstable.
void RunWatch::take_losses(const StepRecord& record) {
  const auto value = [&](const char* name) {
    const auto found = record.scalars.find(name);
    return found == record.scalars.end() ? 0 : found->second;
  };
  const double stiffness = value("shear_stiffness_min");
  if (!material_lost_ && stiffness < 0) {
    const Vec3 place(value("weakest_x"), value("weakest_y"), value("weakest_z"));
    material_lost_ = point_between("loss of strong ellipticity", t_looked_, record, place);
    move_to_root(*material_lost_, stiffness_before_, {record.t, stiffness});
  }
  stiffness_before_ = Sample{record.t, stiffness};
  if (!stability_lost_ && value("negative_eigenvalues") != 0)
    stability_lost_ = point_between("loss of stability", t_looked_, record);
  t_looked_ = record.t;
}

// The condition is local: where it is violated, waves of any short length grow, shorter than the
// cells can show.
void RunWatch::take_surface(const StepRecord& record, const BodyState& state) {
  const bool off = locate_ == LocateCritical::off || when_ == StabilityCheck::off;
  if (surface_lost_ || off || mesh_ || run_.body.viscous() || run_.body.division() ||
      !run_.scene.surfaces.empty())
    return;
  if (!surface_) surface_.emplace(run_.body, run_.reduction.scene().loads);
  const auto found = surface_->weakest(run_.body, state, run_.statics.contacts());
  if (found && found->margin < 0) {
    surface_lost_ = point_between("crease", t_looked_, record, found->place);
    move_to_root(*surface_lost_, margin_before_, {record.t, found->margin});
  }
  margin_before_.reset();
  if (found) margin_before_ = Sample{record.t, found->margin};
}

void RunWatch::take_support(const StepRecord& record) {
  if (record.contacts.empty()) return;
  double pressed = 0;
  for (const auto& [name, contact] : record.contacts)
    for (const Vec3& r : contact.r) pressed += r.norm();
  support_.push_back({record.t, pressed});
  if (support_.size() > 2) support_.erase(support_.begin());
}

// A body that contact alone restrains: its reactions fall to 0 within what is left of the path
// after the last state. By the line through the last two.
std::optional<CriticalPoint> RunWatch::support_lost(const RunEnd& end) const {
  if (end.at != RunEnd::At::no_equilibrium || support_.empty()) return std::nullopt;
  const Sample& last = support_.back();
  double t = last.t;
  if (last.value > 0) {
    if (support_.size() < 2) return std::nullopt;
    const Sample& before = support_.front();
    const double fall = (before.value - last.value) / (last.t - before.t);
    if (!(fall > 0)) return std::nullopt;
    t = last.t + last.value / fall;
    const double increment = last.t - before.t;
    if (t - last.t > 2 * std::max(increment, run_.path.smallest)) return std::nullopt;
  }
  CriticalPoint point;
  point.kind = "loss of support";
  point.t = point.load_factor = t;
  point.within = t - last.t;
  return point;
}

void RunWatch::locate(const RunEnd& end, bool only_contact) {
  if (critical_ || locate_ == LocateCritical::off || when_ == StabilityCheck::off) return;
  if (only_contact) critical_ = support_lost(end);
  if (critical_) return;
  locate_bifurcation(end);
  search_jump();
  // Verdicts that need no search are known to an increment, which a point in the same one beats.
  for (const auto& lost : {material_lost_, surface_lost_, stability_lost_}) {
    const bool first = lost && (!critical_ || lost->t < critical_->t);
    if (first && !(lost->kind == "loss of stability" && !turnings_.empty())) critical_ = lost;
  }
}

// The first suspect that is a jump, unless an earlier critical point is known.
void RunWatch::search_jump() {
  for (const auto& [states, faster] : suspects_) {
    if (critical_ && critical_->t <= states.first.t) break;
    const auto point = locate_jump(run_, states.before, states.first, states.last);
    if (!point) continue;
    critical_ = point;
    jump_ = states;
    break;
  }
  suspects_.clear();
}

void RunWatch::locate_bifurcation(const RunEnd& end) {
  if (!follows_states()) return;
  if (crossing_) {
    const bool breaking = breaking_at(false) && run_.reduction.kind() == Reduction::Kind::symmetry;
    critical_ =
        locate_critical_point(run_, crossing_->before, crossing_->first, crossing_->last, breaking);
  } else if (end.at == RunEnd::At::no_equilibrium && run_.statics.n_unstable() > 0 && last_) {
    critical_ = critical_point_at_end(run_, *before_, *last_, run_.path.smallest);
  }
}

void RunWatch::kept(const StepRecord& step) {
  take_turning(step);
  if (const auto found = step.scalars.find("negative_eigenvalues");
      found != step.scalars.end() && follows_states()) {
    take_state({step.t, run_.state_from(step), static_cast<int>(std::abs(found->second))}, true);
  }
  if (!mesh_ && !run_.body.viscous()) take_surface(step, run_.state_from(step));
  take_losses(step);
  take_support(step);
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

int RunWatch::signatures_at_each_step() const {
  const bool at_the_end = when_ == StabilityCheck::off || when_ == StabilityCheck::last;
  if (mesh_ || at_the_end || !breaking_at(false)) return 0;
  const std::size_t breaking = run_.reduction.symmetry_breaking_dofs().size();
  return breaking > 0 ? 1 + static_cast<int>(breaking) : 0;
}

std::optional<StabilityReport> RunWatch::report_of(const StepRecord& record) {
  if (mesh_) return report_of_point(record);
  StabilityReport report = stability_.look(run_.body, run_.statics);
  report.t = record.t;  // not that of the loads, where their factor is a result
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
  take_turning(record);
  const bool at_end = at_end_of_path(record.t);
  if (when_ == StabilityCheck::off || (when_ == StabilityCheck::last && !at_end)) return true;
  const std::optional<StabilityReport> report = report_of(record);
  if (!report) return true;
  if (follows_states() && report->signature) {
    // where movements that break the symmetry are looked at in the last step only, they are no
    // change from the step before
    int negative = std::abs(report->signature->negative);
    if (report->breaking && breaking_at(false)) negative += std::abs(report->breaking->negative);
    const bool doubtful = run_.statics.n_indefinite() > n_indefinite_;
    n_indefinite_ = run_.statics.n_indefinite();
    take_state({record.t, run_.statics.accepted(), negative}, doubtful);
  }
  if (on_unstable_ == OnUnstable::stop && !critical_) search_jump();
  stability_.keep(*report);
  if (when_ != StabilityCheck::last) stability_.add_to(record, *report);
  take_surface(record, run_.statics.accepted());
  take_losses(record);
  take_support(record);
  last_said_ = in_words(*report);
  if (on_unstable_ != OnUnstable::stop) return true;
  if (jump_) last_said_ = "reached by a jump past a limit point";
  if (last_said_.empty()) return true;
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
  if (critical_) lines.push_back("first critical point: " + critical_->words());
  if (jump_ && critical_)
    lines.push_back(fmt::format(
        "between t = {:.4g} and {:.4g} the run jumped to a distant state, past a limit point; path.arc_length follows the path between them",
        jump_->first.t, jump_->last.t));
  for (const Turning& turning : turnings_) {
    const char* extremum = turning.greatest ? "greatest" : "least";
    lines.push_back(fmt::format("{} has a {} value of {:.6g}{} at t = {:.5g}: a limit point",
                                turning.name, extremum, turning.value, turning.unit, turning.t));
  }
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
  std::vector<Summary> all = stability_.summary();
  if (critical_) {
    all.push_back({"critical_t", critical_->t, "-"});
    all.push_back({"critical_load_factor", critical_->load_factor, "-"});
    if (critical_->angle) all.push_back({"critical_wave_angle", *critical_->angle, "deg"});
  } else if (!turnings_.empty()) {
    all.push_back({"critical_t", turnings_.front().t, "-"});
  }
  return all;
}

std::vector<TextResult> RunWatch::texts() const {
  if (when_ == StabilityCheck::off) return {};
  if (critical_)
    return {{"critical_kind", critical_->kind}, {"critical_symmetry", critical_->symmetry}};
  if (!turnings_.empty()) return {{"critical_kind", "limit point of load"}};
  return {};
}

}  // namespace langer
