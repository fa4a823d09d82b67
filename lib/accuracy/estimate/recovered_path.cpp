#include "accuracy/estimate/recovered_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "accuracy/estimate/cell_parts.hpp"
#include "accuracy/estimate/least_scatter.hpp"

namespace langer {

namespace {

constexpr int unasked_cells =
    60'000;  // without being asked: their stress at all points takes memory
constexpr double least_inside = 0.8;  // of the cells, or it tells nothing
constexpr double beyond_telling =
    0.15;  // share of the energy beyond which cells are too long to tell it
constexpr double between_looks = 0.45;  // of the path, between two looks at the stress
constexpr double no_force_left = 1e-6;  // of the largest force on the path
constexpr double by_increments = 0.04;  // of the force, where one increment makes the path
constexpr double below_edges =
    3;  // what it misses where stresses are singular (ctest -R "within a factor of three")

bool is_homogeneous(const Run& run) { return run.reduction.kind() == Reduction::Kind::homogeneous; }

// between two looks linear
double share_at(const std::vector<std::pair<double, double>>& shares, double t) {
  std::size_t i = 0;
  while (i + 1 < shares.size() && shares[i].first < t) ++i;
  const auto& [t1, share1] = shares[i];
  if (i == 0) return share1;
  const auto& [t0, share0] = shares[i - 1];
  return share0 + (t - t0) / (t1 - t0) * (share1 - share0);
}

// what is told, over the share of the energy
double told_times(const SolveConfig& config) {
  return order_of_force(config) < 2 ? below_edges : 1;
}

// nothing is seen across one cell
bool is_too_thin(const Run& run) {
  return !is_homogeneous(run) && with_a_corner_inside(run.mesh) <= least_inside;
}

Body body_of(const Run& run) {
  return {run.mesh, run.scene.materials, run.scene.directions, run.scene.formulation};
}

}  // namespace

std::string why_not_recovered(const Run& run) {
  if (run.scene.formulation == Formulation::displacement)
    return "formulation: displacement locks, and its stress is smooth";
  if (run.body.viscous()) return "stresses of viscous bodies are not compared";
  if (run.body.loads().follow()) return "pressures follow the surface";
  if (run.scene.materials.size() > 1)
    return "pressures across a soft layer of few cells are not seen";
  for (const RigidContact& contact : run.scene.contacts)
    if (contact.control || contact.adhesion)
      return fmt::format("{} does not move on a prescribed path, or adheres", contact.name);
  return "";
}

bool recovered_by_default(const SolveConfig& config, const Run& run) {
  if (asks_for_accuracy(config) || run.mesh.n_cells() > unasked_cells ||
      !why_not_recovered(run).empty())
    return false;
  return !is_too_thin(run);
}

std::vector<ErrorEstimate> recovered_errors(const SolveConfig& config, const RecoveredError& error,
                                            const StepForces& forces,
                                            const std::vector<Valued>& found, double residual) {
  const bool section = config.mesh && is_section(config.mesh->geometry);
  std::vector<ErrorEstimate> estimates;
  for (const Valued& q : found) {
    const double size = std::abs(q.value);
    ErrorEstimate e{q, 0, 0, 0, residual * size, 2, false};
    if (q.of_force()) {
      const double touching =
          touching_at({forces}, forces.touching.contains(q.name) ? q.name : "force", forces.t);
      e.cells =
          std::max(told_times(config) * error.energy_share(), shear_at_edge(config, touching)) *
          size;
      e.scatter = 0.5 * one_by_one(touching, section) * size;
      if (has_friction(config))
        e.increments = by_increments * std::pow(config.path.largest_increment(), 2) * size;
    } else if (q.name == "von_mises_max") {
      e.cells = error.von_mises_spread;
      e.grows = q.at_edge && e.cells > 0;
    } else {
      continue;
    }
    estimates.push_back(e);
  }
  return estimates;
}

RecoveredPath::RecoveredPath(const Run& run, const SolveConfig& config, bool wanted)
    : run_(run), config_(config) {
  if (wanted) body_ = std::make_unique<Body>(body_of(run));
}

Observer RecoveredPath::beside(Observer observer) {
  if (!wanted()) return observer;
  return {[this, also = observer.kept](const StepRecord& whole) {
            if (also) also(whole);
            look_at(whole);
          },
          [this, along = observer.along](RunListener listener) {
            listener.of_whole = [this, also = std::move(listener.of_whole)](
                                    StepRecord& whole, const SolveReport& report) {
              if (also) also(whole, report);
              look_at(whole);
            };
            if (along) return along(std::move(listener));
            return listener;
          }};
}

// where what is left of the stress is rounding
bool RecoveredPath::unloaded() const {
  if (path_.back().of.empty()) return false;  // forces alone load it
  return std::ranges::all_of(path_.back().of, [&](const auto& force) {
    double most = 0;
    for (const StepForces& step : path_) most = std::max(most, step.of.at(force.first));
    return force.second <= no_force_left * most;
  });
}

void RecoveredPath::look_at(const StepRecord& whole) {
  append_step(path_, step_forces(config_, run_.scene, run_.mesh, whole));
  residuals_.push_back(relative_residual(whole));
  if (is_homogeneous(run_) || at_end_of_path(whole.t) || unloaded()) return;
  if (shares_.empty() || whole.t >= shares_.back().first + between_looks)
    shares_.emplace_back(whole.t, recovered_energy_share(*body_, whole.u));
}

PathErrors RecoveredPath::errors(const StepRecord& last, const std::vector<Valued>& found,
                                 bool resolved) const {
  const bool asked = asks_for_accuracy(config_);
  PathErrors out;
  if (const std::string why = why_not_recovered(run_); !why.empty()) {
    out.not_known = {"recovery does not estimate errors of such a scene: " + why};
    if (asked) return out;
  }
  if (asked && is_too_thin(run_)) return to_be_cut_everywhere(run_.mesh, across_one_cell);
  const bool unloaded_now = unloaded();
  const bool nothing_left = is_homogeneous(run_) || unloaded_now;
  const RecoveredError at_end = nothing_left ? RecoveredError{} : recovered_error(*body_, last.u);
  const StepForces forces = step_forces(config_, run_.scene, run_.mesh, last);
  const std::vector<ErrorEstimate> errors =
      recovered_errors(config_, at_end, forces, unloaded_now ? valued_forces(forces) : found,
                       relative_residual(last));
  if (asked && !nothing_left) out.of_cells = parts(at_end, errors, last);
  if (!resolved) {
    out.not_known.push_back(
        "no error estimate is available: contact is not resolved by the cells, as said above");
    return out;
  }
  if (at_end.energy_share() > beyond_telling) {
    out.not_known.push_back(fmt::format(
        "no error estimate is available: by recovery they are more than {:.0f} % of the force, and that is no more than a sign that "
        "the cells are too long for this scene",
        100 * beyond_telling));
    return out;
  }
  out.at_end = errors;
  auto shares = shares_;
  if (!nothing_left || shares.empty()) shares.emplace_back(last.t, at_end.energy_share());
  std::map<std::string, std::vector<ErrorEstimate>> steps;
  for (std::size_t i = 0; i < path_.size(); ++i) {
    const StepForces& step = path_[i];
    const RecoveredError error{std::sqrt(share_at(shares, step.t))};
    for (ErrorEstimate e :
         recovered_errors(config_, error, step, valued_forces(step), residuals_[i])) {
      if (!e.of.of_force()) continue;  // the spread of stresses is looked at in the last step only
      out.along[e.of.name].push_back(e.total());
      e.t = step.t;
      steps[e.of.name].push_back(std::move(e));
    }
  }
  for (ErrorEstimate& e : out.at_end)
    if (steps.contains(e.of.name)) e = judged_step(steps.at(e.of.name), e);
  return out;
}

// Of a force that is judged before the end of the path the estimate there, else that of the end.
ErrorEstimate RecoveredPath::judged_step(const std::vector<ErrorEstimate>& steps,
                                         const ErrorEstimate& last) const {
  if (config_.accuracy && config_.accuracy->at == AccuracyAt::every_step) return worst_of(steps);
  const double t = judged_at(config_, path_, last.of.name);
  for (const ErrorEstimate& e : steps)
    if (e.t == t && t < 1) return e;
  return last;
}

// of the force whose bar is widest, relative to it: those of the stress, and of those that are
// touched what nodes make
std::vector<double> RecoveredPath::parts(const RecoveredError& error,
                                         const std::vector<ErrorEstimate>& errors,
                                         const StepRecord& last) const {
  const double times = told_times(config_);
  const double smooth = times * error.energy_share();
  double whole = smooth;
  for (const ErrorEstimate& e : forces_judged(errors))
    if (const double size = std::abs(e.of.value); size > 0)
      whole = std::max(whole, (e.total() - e.increments) / size);
  return parts_of(error.of_cell, times, touched_cells(run_, last), whole - smooth);
}

}  // namespace langer
