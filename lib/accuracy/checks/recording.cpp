#include "accuracy/checks/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/interrupt.hpp"
#include "core/base/stopwatch.hpp"
#include "core/base/text.hpp"
#include "core/hdf5/seal.hpp"
#include "mechanics/contact/surface_check.hpp"
#include "results/store/vtu.hpp"
#include "scene/run/by_node.hpp"
#include "scene/run/continued.hpp"
#include "scene/run/step_record.hpp"

namespace langer {

namespace {

// A critical point as solution_critical.csv beside solution.h5, and its mode as solution_mode.vtu.
// Both are there for a run that ends before the end of its path, too.
void write_critical_point(const Mesh& mesh, const CriticalPoint& point, const std::string& output) {
  std::string name = output;
  if (name.ends_with(".h5")) name.resize(name.size() - 3);
  write_text_file(name + "_critical.csv", table_of(point));
  if (point.mode.empty()) return;
  Field field{"mode", "-", 3, {}};
  for (const Vec3& u : point.mode)
    for (int k = 0; k < 3; ++k) field.values.push_back(u[k]);
  write_vtu(name + "_mode.vtu", mesh, point.t, {field}, {});
}

// What helps where edges of an indenter from a file have a radius below the distance of the nodes
// that touch: a node that is pushed over such an edge slips down its other side at once, however
// short the increment is. Empty where there is no such indenter.
std::string nodes_slip_over_edges(const Run& run) {
  const IncrementState& state = run.increment.state();
  const auto& last = run.increment.accepted();
  const std::vector<Vec3> places = state.indenters(last.t, last.travel);
  const std::vector<Vec3> u = by_node(last.u);
  const SurfaceCheck check(state.body.mesh());
  for (std::size_t k = 0; k < state.contacts.size(); ++k) {
    const RigidContact& contact = state.contacts[k];
    const auto* indenter = std::get_if<Facets>(&contact.shape);
    if (!indenter) continue;
    const double apart = 2 * check.look(contact, u, places[k], last.r[k]).spacing;
    if (!std::isfinite(apart) || indenter->rounding >= apart) continue;
    return fmt::format(
        "contacts.{}.rigid.facets.rounding is {:.3g} mm, and nodes that touch are {:.2g} mm apart: "
        "they slip over the edges of the file one by one; a rounding of at least {:.2g} mm helps "
        "(smaller `scale` and another `move` keep the size), or shorter cells",
        contact.name, indenter->rounding, apart, apart);
  }
  return "";
}

// What helps where no equilibrium is found; continues "kept: 3 steps in x.part (".
std::string cure_of_failure(const Run& run, const PathReport& path, const std::string& loose) {
  if (!loose.empty())
    return "a run of this config continues from there); hold also a node on the indenter's axis "
           "and, against turning, one next to it, where contact does not: that begins anew";
  // Where the tangent has a negative direction under forces, no shorter increment passes.
  if (run.increment.n_unstable() > 0 && !run.body.loads().empty()) {
    const double reached = std::floor(1e3 * path.t) / 1e3;
    return fmt::format(
        "the next run continues from there, but shorter increments do not pass a limit point); "
        "the last equilibrium is at {:g} of the path: end the loads there (loads in proportion to "
        "t: {:g} times their values), impose a displacement and no force, or follow the path past its limit point with "
        "path.arc_length",
        reached, reached);
  }
  if (run.body.loads().follow())
    return "the next run continues from there); the tangent of a pressure whose rim is free is not "
           "symmetric, and Newton's method has the symmetric part of it: solver: {kinsol: "
           "{strategy: picard}} goes further, and begins anew";
  if (const std::string why = nodes_slip_over_edges(run); !why.empty())
    return "the next run continues from there); " + why;
  return "the next run continues from there); try path.smallest or solver.newton.iterations";
}

}  // namespace

Recording::Recording(Run& run, RunWatch& watch, const SolveConfig& config, const Identity& identity,
                     const std::string& output, Observer observer)
    : run_(run),
      watch_(watch),
      output_(output),
      config_(identity.config),
      observer_(std::move(observer)),
      stress_(run.mesh, run.scene, config.cell_stress),
      impact_(run.scene, run.inertia.get()),
      collect_(collector(config)),
      file_(
          output,
          header_of(run.mesh, run.scene.formulation, run.scene, with_steps_hash(identity, config)),
          with_replay(within_tolerance(config))),
      resumed_(file_.resumed()) {
  if (resumed_) run_.resume(*resumed_, file_.before_resumed());
}

std::function<void(const StepRecord&)> Recording::collector(const SolveConfig& config) {
  if (!by_refinement(config)) return {};
  return [this, config](const StepRecord& step) {
    append_step(forces_, step_forces(config, run_.scene, run_.mesh, step));
  };
}

SolutionWriter::StillGood Recording::with_replay(SolutionWriter::StillGood good) {
  return [this, good = std::move(good)](const StepRecord& step, const EarlierRun& earlier) {
    if (!good(step, earlier)) return false;
    if (collect_) collect_(step);
    watch_.kept(step);
    run_.replay(step);
    stress_.kept(step);
    impact_.add(step);
    if (observer_.kept) observer_.kept(step);
    return true;
  };
}

bool Recording::with_other_settings() const {
  return std::any_of(file_.earlier().begin(), file_.earlier().end(),
                     [&](const EarlierRun& earlier) { return earlier.config != config_; });
}

RunEnd Recording::follow(const Voice& voice, Progress& progress, const std::string& loose) {
  if (!loose.empty()) voice.detail("{}: only contact holds it", loose);
  if (with_other_settings())
    voice.say(
        "these steps were made with other settings: /provenance/earlier of the result holds them");
  const RunEnd end = along_the_path(progress);
  if (end.at == RunEnd::At::not_homogeneous) return end;
  watch_.locate(end, !loose.empty());
  if (const auto& critical = watch_.critical()) write_critical_point(run_.mesh, *critical, output_);
  for (const std::string& line : watch_.warnings()) voice.warn(line);
  for (const std::string& line : watch_.notes()) voice.detail("{}", line);
  if (end.path.complete)
    for (const std::string& line : watch_.contact_warnings()) voice.warn(line);
  need_the_end(end, loose);
  return end;
}

RunEnd Recording::along_the_path(Progress& progress) {
  RunListener listener;
  listener.watched = [&](Problem problem, double t) {
    return progress.watched(std::move(problem), t);
  };
  listener.jumping = [&](double t, int equilibria) {
    progress.jumping(t, equilibria);
  };
  listener.failed = [&](double t, const SolveReport& report) {
    progress.failed(t, report);
  };
  listener.of_part = [&](StepRecord& record) {
    return watch_.of_part(record);
  };
  listener.of_whole = [&](StepRecord& record, const SolveReport& report) {
    if (auto refused = watch_.of_whole(record, report)) {
      refused->hint += fmt::format("; kept: the {} step{} before in {}.part", n_steps(),
                                   plural_s(n_steps()), output_);
      throw Failure(Exit::not_converged, *refused);
    }
    {
      const Stopwatch writing(seconds_);
      stress_.add(record);
      file_.append(record);
    }
    impact_.add(record);
    if (collect_) collect_(record);
    progress.accepted(record, report);
  };
  if (resumed_) progress.resumed(n_steps(), resumed_->t);
  if (observer_.along) listener = observer_.along(std::move(listener));
  RunEnd end = run_.follow(listener);
  if (resumed_ && end.last.u.empty()) end.last = *resumed_;  // it was at the end
  return end;
}

void Recording::need_the_end(const RunEnd& end, const std::string& loose) const {
  const auto fail = [](Exit code, std::string found, std::string expected, std::string hint) {
    throw Failure(code, Error{{}, "", std::move(found), std::move(expected), std::move(hint)});
  };
  if (end.at == RunEnd::At::listener)
    fail(Exit::not_converged, watch_.unstable(), "a stable state (on_unstable: stop)",
         fmt::format("kept: the {} step{} before in {}.part; on_unstable: warn continues",
                     n_steps(), plural_s(n_steps()), output_));
  if (end.at == RunEnd::At::signal)
    fail(exit_code_of(interrupted()),
         fmt::format("stopped by {} at t = {:.6g} after {} steps", signal_name(interrupted()),
                     end.path.t, n_steps()),
         "", fmt::format("kept: {}.part (the next run continues from there)", output_));
  if (end.at != RunEnd::At::no_equilibrium) return;
  std::string found =
      fmt::format("stopped at t = {:.6g} after {} steps: {}", end.path.t, n_steps(), end.path.why);
  if (run_.increment.n_unstable() > 0)
    found += "; the body itself gives way (tangent not positive definite)";
  if (watch_.critical()) found += "; " + watch_.critical()->words();
  if (!watch_.last_said().empty()) found += "; at the last state " + watch_.last_said();
  if (!loose.empty()) found += "; " + loose;
  found += "; smallest increment reached";
  fail(Exit::not_converged, found, "",
       fmt::format("kept: {} steps in {}.part ({}", n_steps(), output_,
                   cure_of_failure(run_, end.path, loose)));
}

void Recording::stopped_in_estimate() const {
  throw Failure(
      exit_code_of(interrupted()),
      Error{
          {},
          "",
          fmt::format("stopped by {} while its errors were estimated; the path is at its end",
                      signal_name(interrupted())),
          "",
          fmt::format(
              "kept: all {} steps in {}.part (the next run continues with the estimate, --set estimate=none ends "
              "without it)",
              n_steps(), output_)});
}

}  // namespace langer
