#include "scene/run/run.hpp"
#include "core/base/text.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/interrupt.hpp"
#include "core/base/stopwatch.hpp"
#include "mechanics/solve/pull_between.hpp"
#include "mechanics/solve/release.hpp"
#include "scene/model/torque.hpp"
#include "scene/run/equilibrium_by.hpp"
#include "scene/run/motion_record.hpp"
#include "scene/run/step_record.hpp"

namespace langer {

namespace {

// What the greatest pull of an adhesive indenter may lack between two increments, over that pull.
constexpr double most_pull_between = 0.01;

IncrementOptions threads_of(const SolveConfig& config) {
  IncrementOptions options;
  options.threads = config.blas_threads;
  options.seconds = config.path.seconds.value_or(0);
  if (const auto* newton = std::get_if<NewtonOptions>(&config.solver))
    options.linear_by = newton->linear;
  if (config.path.arc_length || config.branch || config.imperfection)
    options.linear_by = LinearBy::direct;
  if (config.path.arc_length) options.contact_by = ContactBy::compliance;
  return options;
}

IncrementOptions with_seconds(IncrementOptions options, const LoadPathOptions& path) {
  options.seconds = path.seconds.value_or(0);
  return options;
}

IncrementOptions with_inertia(IncrementOptions options, Inertia* inertia) {
  options.inertia = inertia;
  if (inertia) options.linear_by = LinearBy::direct;
  return options;
}

// energy_momentum keeps energies to what Newton's method leaves of the balance, thousands of times.
Solver with_tolerance(Solver solver, const Inertia* inertia) {
  if (!inertia || !inertia->conserves()) return solver;
  if (auto* newton = std::get_if<NewtonOptions>(&solver)) {
    newton->relative = std::min(newton->relative, 1e-11);
  }
  return solver;
}

}  // namespace

Run::Run(Mesh mesh_, const SolveConfig& config, const std::optional<Material>& material,
         const Where& where, bool at_a_point, bool by_ranks)
    : mesh(std::move(mesh_)),
      scene(make_scene(config, mesh, material, where)),
      reduction(Reduction::find(mesh, scene, config, where, at_a_point)),
      body(
          reduction.assembler(by_ranks ? divided(reduction, config, serial_reason) : std::nullopt)),
      inertia(inertia_of(reduction, body, config.path, where("dynamics"))),
      increment(body, reduction.scene().contacts, with_inertia(threads_of(config), inertia.get()),
                reduction.scene().surfaces),
      path(motion_path(scene, config.path)),
      solver(with_tolerance(reduction.solver(config.solver), inertia.get())) {}

Run::Run(Mesh mesh_, Scene scene_, const std::optional<ReducedScene>& part,
         const LoadPathOptions& path_, Solver solver_, const IncrementOptions& options)
    : mesh(std::move(mesh_)),
      scene(std::move(scene_)),
      reduction(mesh, scene, part),
      body(reduction.assembler()),
      inertia(inertia_of(reduction, body, path_, {})),
      increment(body, reduction.scene().contacts,
                with_inertia(with_seconds(options, path_), inertia.get()),
                reduction.scene().surfaces),
      path(motion_path(scene, path_)),
      solver(with_tolerance(std::move(solver_), inertia.get())) {}

// Restores a recorded step and the one before it. Both are needed for the same continuation to the
// last digit: the first trial state is extrapolated from them.
void Run::resume(const StepRecord& last, const std::optional<StepRecord>& before) {
  BodyState earlier = before ? state_from(*before) : at_rest(increment.accepted());
  increment_ = last.scalars.at("next_increment");
  resumed_ = Resumed{state_from(last), std::move(earlier), *increment_};
  increment.restore(resumed_->now, &resumed_->before);
  t_ = last.t;
}

BodyState Run::state_from(const StepRecord& step) const {
  BodyState state = reduction.reduced(step);
  state.t = load_factor_of(step);
  state.pressures = pressures_of(step, body.loads());
  return state;
}

void Run::begin(double t) {
  if (switch_ && std::abs(t_ - switch_->t) <= 1e-12) {
    begin_branch(t);
  } else if (path.arc_length) {
    increment.begin_arc(path.arc_length->length * (t - t_));
  } else {
    increment.begin(t);
  }
}

// Where a body is not stable without its contacts, the increment is begun again with contact in the
// tangent, and once more as it was, with springs, if that finds no equilibrium. An increment that
// has begun is not gone on with: what springs moved is far from the path.
SolveReport Run::solved_from_begin(double t, const std::function<SolveReport()>& solve) {
  begin(t);
  if (!increment.may_go_into_tangent()) return solve();
  increment.where_unstable(Increment::WhereUnstable::stop);
  SolveReport report = solve();
  if (!increment.stopped_unstable()) return report;
  begin(t);
  increment.where_unstable(Increment::WhereUnstable::contact_in_tangent);
  report = solve();
  if (report.converged() || report.outcome == Outcome::stopped) return report;
  begin(t);
  return solve();
}

SolveReport Run::solve_at(double t) {
  return solved_from_begin(t, [&] { return equilibrium_by(solver, increment); });
}

void Run::put_at(double t, const BodyState& state, const BodyState& before) {
  increment.restore(state, &before);
  t_ = t;
}

// The first increment of a branch. With arc lengths it goes along the mode. At a given t the trial
// state is found in two steps: the equilibrium at which the mode has the amplitude of the config,
// its t being an unknown, and then the same movement scaled to t, as a fork opens with the square
// root of the distance from its beginning.
void Run::begin_branch(double t) {
  if (path.arc_length) {
    const VecX towards = switch_->mode;
    increment.begin_arc(path.arc_length->length * (t - t_), &towards);
    return;
  }
  const BodyState at = increment.accepted();
  increment.begin_along(switch_->mode / switch_->mode.norm(),
                        switch_->amplitude * switch_->mode.norm());
  const SolveReport report = equilibrium_by(solver, increment);
  const double found = increment.trial_t();
  const VecX step = increment.trial() - at.u;
  increment.begin(t);
  if (!report.converged() || !(found > switch_->t)) return;
  const VecX guess = at.u + std::sqrt((t - at.t) / (found - at.t)) * step;
  increment.begin_from(guess);
}

// In a shared run only rank 0 reads the file; the other ranks receive its state.
void Run::resume_all() {
  if (shared_by() && share(*shared_by(), resumed_, increment.accepted()) && !shared_by()->first()) {
    increment_ = resumed_->increment;
    increment.restore(resumed_->now, &resumed_->before);
    t_ = resumed_->now.t;
  }
  resumed_.reset();
}

void Run::replay(const StepRecord& step) {
  if (!body.viscous()) return;
  increment.replay(state_from(step));
  reduction.replay(step);
}

// Records an accepted state for the listeners. At::the_end means that the path continues.
RunEnd::At Run::record_step(const RunListener& listener, double t, double taken, double next,
                            const SolveReport& report, RunEnd& end) {
  const bool at_end = at_end_of_path(t);
  if (!at_end && !listener.of_part && !listener.of_whole && !body.viscous())
    return RunEnd::At::the_end;
  StepRecord record = step_record(increment, body, taken, next, report);
  if (path.seconds) record.scalars["time"] = t * *path.seconds;
  if (path.arc_length) {
    record.scalars["load_factor"] = record.t;
    record.t = t;
  }
  if (switch_) record.scalars["branch"] = t > switch_->t + 1e-12 ? switch_->sign : 0;
  if (listener.of_part && !listener.of_part(record)) return RunEnd::At::listener;
  std::optional<StepRecord> whole = reduction.whole(record);
  if (!whole) return RunEnd::At::not_homogeneous;
  add_torques(*whole, mesh, scene);
  if (listener.of_whole) listener.of_whole(*whole, reduction.report(report, *whole));
  if (at_end) end.last = std::move(*whole);
  return RunEnd::At::the_end;
}

// Follows the path with adaptive increments: `attempt` solves one increment, `accepted` records it.
// An increment is rejected, and repeated with a smaller one, if it finds no equilibrium, takes
// longer than allowed, or lets the surface pass an edge of an indenter.
RunEnd Run::follow(const RunListener& listener) {
  RunEnd end;
  int signal = 0;
  const auto attempt = [&](double t) {
    const auto stopped = [&] {
      signal = signal_of(shared_by());
      return signal != 0;
    };
    if (stopped()) return SolveReport{.outcome = Outcome::stopped, .why = "stopped by a signal"};
    const double began = wall_seconds();
    bool too_slow = false;
    const auto stopped_or_slow = [&] {
      double seconds = wall_seconds() - began;
      if (path.longest_attempt && shared_by()) seconds = shared_by()->largest(seconds);
      too_slow = path.longest_attempt && seconds > *path.longest_attempt;
      return stopped() || too_slow;
    };
    const auto solve = [&] {
      Problem problem = increment.problem();
      problem.stopped = stopped_or_slow;
      if (listener.watched) problem = listener.watched(std::move(problem), t);
      return equilibrium_by(solver, increment, problem);
    };
    const auto jumping = [&](int equilibria) {
      if (listener.jumping) listener.jumping(t, equilibria);
    };
    SolveReport report;
    if (increment.bonds().none()) {
      report = solved_from_begin(t, solve);
    } else {
      begin(t);
      report = adhesive_equilibrium(increment, t, path.shortest_with_a_jump(), solve, jumping);
    }
    if (!report.converged() && too_slow && signal == 0) {
      report.outcome = Outcome::not_converged;
      report.why = "the attempt takes longer than path.longest_attempt";
    }
    // In a longer increment the surface may pass an edge that it would not pass in shorter ones.
    const double length = t - increment.accepted().t;
    if (report.converged() && length > path.shortest_past_an_edge()) {
      if (const std::optional<std::string> indenter = increment.edge_passed()) {
        report.outcome = Outcome::not_converged;
        report.why =
            "the surface passes an edge of the indenter \"" + *indenter + "\" within one increment";
      }
    }
    if (report.converged() && body.viscous()) report.time_error = increment.time_error();
    if (report.converged()) {
      report.time_error = std::max(report.time_error, increment.bonds().time_error());
      // The top of a pull is to be met by the ends of increments. Where bonds jump, no length of
      // them would do.
      if (!increment.bonds().none() && length > path.shortest_with_a_jump()) {
        const double parts = pull_between(increment) / most_pull_between;
        // errors grow with the third power of an increment, and this one with the second
        report.time_error = std::max(report.time_error, path.time_error * std::pow(parts, 1.5));
      }
    }
    if (report.converged() && inertia && !scene.motion_step) {
      report.time_error = std::max(report.time_error,
                                   path.time_error / scene.motion_error * increment.motion_error());
    }
    if (!report.converged() && listener.failed && !interrupted()) listener.failed(t, report);
    return report;
  };
  const auto accepted = [&](double t, double taken, double next, const SolveReport& report) {
    increment.accept();
    t_ = t;
    const auto record = [&] {
      end.at = record_step(listener, t, taken, next, report, end);
      return end.at == RunEnd::At::the_end;
    };
    return on_root_rank(shared_by(), record) && (signal = signal_of(shared_by())) == 0;
  };
  // An increment of a body in motion ends where something touches, so that no touch falls into one.
  std::function<double(double)> cut;
  if (inertia)
    cut = [this](double t) {
      return increment.end_at_touch(t);
    };
  std::vector<double> stops = reduction.scene().stops;
  if (switch_) stops.push_back(switch_->t);
  end.path = load_path(path, t_, increment_, stops, attempt, accepted, cut);
  if (!shared_by()) signal = interrupted();
  if (!end.path.complete && end.at == RunEnd::At::the_end)
    end.at = signal != 0 ? RunEnd::At::signal : RunEnd::At::no_equilibrium;
  return end;
}

}  // namespace langer
