#include "run/run.hpp"

#include "base/interrupt.hpp"
#include "run/equilibrium_by.hpp"
#include "run/step_record.hpp"
#include "scene/torque.hpp"
#include "solve/release.hpp"

namespace langer {

namespace {

StaticsOptions threads_of(const SolveConfig& config) {
  StaticsOptions options;
  options.threads = config.blas_threads;
  options.seconds = config.path.seconds.value_or(0);
  if (const auto* newton = std::get_if<NewtonOptions>(&config.solver)) options.linear_by = newton->linear;
  return options;
}

StaticsOptions with_seconds(StaticsOptions options, const LoadPathOptions& path) {
  options.seconds = path.seconds.value_or(0);
  return options;
}

}  // namespace

Run::Run(Mesh mesh_, const SolveConfig& config, const std::optional<Material>& material, const Where& where, bool at_a_point)
    : mesh(std::move(mesh_)),
      scene(make_scene(config, mesh, material, where)),
      reduction(Reduction::find(mesh, scene, config, where, at_a_point)),
      body(reduction.equilibrium()),
      statics(body, reduction.scene().contacts, threads_of(config)),
      path(config.path),
      solver(reduction.solver(config.solver)) {}

Run::Run(Mesh mesh_, Scene scene_, const std::optional<ReducedScene>& part, const LoadPathOptions& path_, Solver solver_,
         const StaticsOptions& options)
    : mesh(std::move(mesh_)),
      scene(std::move(scene_)),
      reduction(mesh, scene, part),
      body(reduction.equilibrium()),
      statics(body, reduction.scene().contacts, with_seconds(options, path_)),
      path(path_),
      solver(std::move(solver_)) {}

void Run::resume(const StepRecord& last, const std::optional<StepRecord>& before) {
  BodyState earlier = statics.accepted();
  if (before)
    earlier = reduction.reduced(*before);
  else {
    earlier.t = 0, earlier.u.setZero();
    for (auto& reactions : earlier.r) std::fill(reactions.begin(), reactions.end(), Vec3(Vec3::Zero()));
  }
  statics.restore(reduction.reduced(last), &earlier);
  increment_ = last.scalars.at("next_increment");
}

void Run::replay(const StepRecord& step) {
  if (!body.viscous()) return;
  statics.replay(reduction.reduced(step));
  reduction.replay(step);
}

RunEnd Run::follow(const RunListener& listener) {
  RunEnd end;
  const auto attempt = [&](double t) {
    if (interrupted()) return SolveReport{};  // not converged
    statics.begin(t);
    const auto solve = [&] {
      return equilibrium_by(solver, statics, listener.watched ? listener.watched(statics.problem(), t) : statics.problem());
    };
    const auto jumping = [&](int equilibria) {
      if (listener.jumping) listener.jumping(t, equilibria);
    };
    SolveReport report =
        statics.bonds().none() ? solve() : adhesive_equilibrium(statics, t, path.shortest_with_a_jump(), solve, jumping);
    if (report.converged() && body.viscous()) report.time_error = statics.time_error();
    if (!report.converged() && listener.failed && !interrupted()) listener.failed(t, report);
    return report;
  };
  const auto accepted = [&](double t, double taken, double next, const SolveReport& report) {
    statics.accept();
    const bool at_end = at_end_of_path(t);
    if (!at_end && !listener.of_part && !listener.of_whole && !body.viscous()) return !interrupted();
    StepRecord record = step_record(statics, body, taken, next, report);
    if (path.seconds) record.scalars["time"] = t * *path.seconds;
    if (listener.of_part && !listener.of_part(record)) {
      end.at = RunEnd::At::listener;
      return false;
    }
    std::optional<StepRecord> whole = reduction.whole(record);
    if (!whole) {
      end.at = RunEnd::At::not_homogeneous;
      return false;
    }
    tell_torques(*whole, mesh, scene);
    if (listener.of_whole) listener.of_whole(*whole, reduction.report(report, *whole));
    if (at_end) end.last = std::move(*whole);
    return !interrupted();
  };
  end.path = load_path(path, statics.accepted().t, increment_, reduction.scene().stops, attempt, accepted);
  if (!end.path.complete && end.at == RunEnd::At::the_end) end.at = interrupted() ? RunEnd::At::signal : RunEnd::At::no_equilibrium;
  return end;
}

}  // namespace langer
