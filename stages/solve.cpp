// langer-solve: equilibrium along a load path.
//   langer-solve indentation.yaml --mesh mesh.h5 --material material.h5 -o solution.h5
#include <fmt/format.h>

#include <algorithm>

#include "assembly/equilibrium.hpp"
#include "base/memory.hpp"
#include "base/stopwatch.hpp"
#include "mesh/quality.hpp"
#include "run/accuracy.hpp"
#include "run/contact_watch.hpp"
#include "run/continued.hpp"
#include "run/dry_run.hpp"
#include "run/equilibrium_by.hpp"
#include "run/error_estimate.hpp"
#include "run/homogeneous.hpp"
#include "run/progress.hpp"
#include "run/result_watch.hpp"
#include "run/stability_watch.hpp"
#include "run/step_record.hpp"
#include "scene/make_mesh.hpp"
#include "scene/scene.hpp"
#include "scene/symmetry.hpp"
#include "solve/load_path.hpp"
#include "solve/statics.hpp"
#include "solve/zero_energy_modes.hpp"
#include "stage.hpp"
#include "store/mesh_file.hpp"
#include "store/solution_file.hpp"

namespace langer {
namespace {

// Meshes may come from elsewhere than langer-mesh.
void refuse_bad(const Mesh& mesh, const std::string& file) {
  const auto refuse = [&](std::string found, const char* expected) {
    throw Failure(Exit::input, Error{{file}, "", std::move(found), expected, ""});
  };
  const Quality q = quality(mesh);
  if (!(q.least_jacobian > 0))
    refuse(fmt::format("cell {} is folded or flat: Jacobian {:.3g} mm^3 at ({:.4g}, {:.4g}, {:.4g})", q.at_cell, q.least_jacobian,
                       q.at[0], q.at[1], q.at[2]),
           "a positive Jacobian everywhere");
  if (const auto pair = coincident_nodes(mesh, 1e-9 * q.shortest_edge)) {
    const Vec3& X = mesh.X[static_cast<std::size_t>((*pair)[0])];
    refuse(fmt::format("nodes {} and {} are both at ({:.6g}, {:.6g}, {:.6g}) mm: the body is torn there", (*pair)[0], (*pair)[1],
                       X[0], X[1], X[2]),
           "each place once");
  }
}

// the mesh that the config describes
Mesh mesh_in(const SolveConfig& config, const Where& where) {
  try {
    return make_mesh(*config.mesh, [](const std::string&) { return Place{}; }).mesh;
  } catch (const Failure& failure) {
    std::vector<Error> errors = failure.errors();
    for (Error& e : errors) e.where = where("mesh." + e.key), e.key = "mesh." + e.key;
    throw Failure(failure.code(), errors);
  }
}

// "force 10.7 N +- 0.9 % (cells +0.8, increments -0.1, scatter 0.2, solver 1e-7 %); limit 10.6", a line for each quantity; what gather
// can collect
std::vector<Summary> say_errors(const Job<SolveConfig>& job, const SolveConfig& config, const std::optional<Material>& material,
                                const Scene& scene, const Mesh& mesh, const StepRecord& last) {
  std::vector<Summary> summary;
  std::vector<ErrorEstimate> estimates;
  const std::vector<Valued> found = valued(scene, mesh, last);
  try {
    estimates = config.estimate == EstimateBy::recovery ? recovered_errors(scene, mesh, last, found)
                                                        : estimate_errors(config, material, job.where, found, last.residual);
  } catch (const Failure& failure) {  // the result itself stands
    if (failure.code() != Exit::not_converged) throw;
    job.say("warning: errors are not estimated: {}", failure.what());
  }
  for (const ErrorEstimate& e : estimates) {
    const double whole = 100 / std::max(std::abs(e.of.value), 1e-300);
    summary.push_back({e.of.name + "_error", e.total(), e.of.unit});
    summary.push_back({e.of.name + "_error_cells", e.cells, e.of.unit});
    if (e.has_limit) {
      job.say("{} {:.4g} {} +- {:.2g} % (cells {:+.2g}, increments {:+.2g}, scatter {:.2g}, solver {:.1g} %); limit {:.4g}",
              e.of.name, e.of.value, e.of.unit, whole * e.total(), whole * e.cells, whole * e.increments, whole * e.scatter,
              whole * e.solver, e.limit());
      summary.push_back({e.of.name + "_limit", e.limit(), e.of.unit});
      summary.push_back({e.of.name + "_error_increments", e.increments, e.of.unit});
      summary.push_back({e.of.name + "_error_scatter", e.scatter, e.of.unit});
    } else {
      job.say("{} {:.4g} {} +- {:.2g} % (cells {:.2g} by recovery, solver {:.1g} %)", e.of.name, e.of.value, e.of.unit,
              whole * e.total(), whole * e.cells, whole * e.solver);
    }
    summary.push_back({e.of.name + "_error_solver", e.solver, e.of.unit});
  }
  return summary;
}

// Nothing where a body that was solved at a point ceases to deform alike everywhere: its steps before are kept, to continue from.
std::optional<std::vector<Summary>> solve_by(const Job<SolveConfig>& job, bool at_a_point) {
  const double began = wall_seconds();
  SolveConfig config = job.config;
  const std::optional<Material> material =
      job.has("material") ? std::optional(material_of_body(job.input("material"))) : config.material;
  const std::optional<ChosenRung> rung = choose_accuracy(config, material);
  if (rung) job.say("accuracy: {}", rung->words);
  const Mesh mesh = job.has("mesh") ? read_mesh(job.input("mesh")).mesh : mesh_in(config, job.where);
  refuse_bad(mesh, job.has("mesh") ? job.input("mesh") : "");
  const Scene whole = make_scene(config, mesh, material, job.where);
  for (const Material& m : whole.materials)
    if (at_rest(m) == AtRest::unstable) job.say("warning: a law is {}", at_rest_in_words(m));
  const FibreJump jump = whole.families() > 0 ? largest_jump(mesh, [&](int e) { return whole.fibres_of(mesh, e); }) : FibreJump{};
  if (jump.degrees > 1e-3)
    job.say("fibres turn by up to {:.3g} degrees between neighbours: cells {} and {}, at ({:.4g}, {:.4g}, {:.4g}) mm", jump.degrees,
            jump.cell, jump.neighbour, jump.place[0], jump.place[1], jump.place[2]);
  std::optional<ContactWatch> contact_watch;
  if (!whole.contacts.empty()) contact_watch.emplace(mesh, whole, job.where);
  const std::unique_ptr<HomogeneousScene> point = at_a_point ? HomogeneousScene::find(mesh, whole, config) : nullptr;
  if (point) job.say("homogeneous: one hexahedron stands for {} cells", mesh.n_cells());
  const std::optional<ReducedScene> part = point ? std::nullopt : ReducedScene::find(config.symmetry, mesh, whole, job.where);
  if (part) job.say("{}{}", mesh.section ? "" : "symmetry: ", part->words());
  const Scene& scene = point ? point->scene() : part ? part->scene() : whole;
  Equilibrium body = point ? point->equilibrium() : equilibrium_of(mesh, whole, part, config.threads);
  const auto state = [&](const StepRecord& record) {
    return point ? point->reduced(record) : part ? part->reduced(record) : state_of(record, scene);
  };
  const auto solver = point ? point->solver() : config.solver;
  bool homogeneous = true;
  StaticsOptions options;
  options.threads = config.blas_threads;
  Statics statics(body, scene.contacts, options);
  if (job.dry_run)
    return dry_run(config, scene, body, statics,
                   config.estimate == EstimateBy::second_rung ? estimate_seconds(config, material, job.where) : 0, job.quiet);
  need_memory(statics, config.threads);
  SolutionWriter file(job.output, header_of(mesh, whole.formulation, whole, with_steps_hash(job.identity, job.config)),
                      within_tolerance(config));
  Progress progress(job.quiet, job.verbose, body, scene);
  const std::string held_by_contact = zero_energy_modes(mesh, mesh.section ? scene.dofs : whole.dofs);
  if (!held_by_contact.empty() && scene.contacts.empty())
    throw Failure(Exit::config, Error{job.where("supports"), "supports", held_by_contact, "a body that is held, or contacts", ""});
  if (!held_by_contact.empty()) job.say("{}: only contact holds it", held_by_contact);
  StabilityWatch watch(job.has("material") ? study_from(job.input("material")) : StudyRecord{});
  ResultWatch result(body);
  std::string unstable;   // what ended the path, where it was that
  std::string last_said;  // of the last state's stability

  double files = 0;  // CPU seconds
  StepRecord last;   // at the end of the path
  std::optional<double> increment;
  const bool from_the_start = !file.resumed();
  if (const auto saved = file.resumed()) {
    const auto before = file.before_resumed();
    const BodyState earlier = before ? state(*before) : statics.accepted();  // at rest
    statics.restore(state(*saved), &earlier);
    increment = saved->scalars.at("next_increment");
    watch.resume(*saved);
    if (contact_watch) contact_watch->resume(*saved);
    if (const auto found = saved->scalars.find("shear_stiffness_min"); found != saved->scalars.end() && found->second < 0)
      last_said = fmt::format("strong ellipticity is lost (minimum acoustic eigenvalue {:.3g} MPa)", found->second);
    progress.resumed(file.n_steps(), saved->t);
    if (std::any_of(file.earlier().begin(), file.earlier().end(),
                    [&](const EarlierRun& run) { return run.config != job.identity.config; }))
      job.say("these steps were made with other settings: /provenance/earlier of the result holds them");
    last = *saved;
  }
  const Interruptible at_the_end_of_a_step;
  const PathReport path = load_path(
      config.path, statics.accepted().t, increment, scene.stops,
      [&](double t) {
        if (interrupted()) return SolveReport{};  // not converged
        statics.begin(t);
        const SolveReport report = equilibrium_by(solver, statics, progress.watched(statics.problem(), t));
        if (!report.converged()) progress.failed(t, report);
        return report;
      },
      [&](double t, double taken, double next, const SolveReport& report) {
        statics.accept();
        StepRecord record = step_record(statics, body, taken, next, report);
        const bool end = t >= 1 - 1e-10;
        if (config.stability == StabilityCheck::each_step || (config.stability == StabilityCheck::last && end)) {
          const StabilityReport stability = watch.look(body, statics);
          watch.keep(stability);
          if (config.stability == StabilityCheck::each_step) watch.add_to(record, stability);
          const std::string words = in_words(stability);
          last_said = words;
          if (!words.empty() && config.on_unstable == OnUnstable::stop) {
            unstable = fmt::format("unstable at t = {:.6g}: {}", t, words);
            return false;
          }
        }
        SolveReport found = report;
        if (part) record = part->whole(record);
        if (point) {
          const std::optional<StepRecord> balanced = point->whole(record);
          homogeneous = balanced.has_value();
          if (!homogeneous) return false;
          record = *balanced;
          found.residual = std::max(found.residual, record.residual * report.reference);
        }
        if (contact_watch) contact_watch->look(record);
        result.look(t, statics.accepted().u, found);
        if (auto refused = result.refusal()) {
          refused->hint += fmt::format("; kept: the {} steps before in {}.part", file.n_steps(), job.output);
          throw Failure(Exit::not_converged, *refused);
        }
        if (end) last = record;
        {
          const Stopwatch writing(files);
          file.append(record);
        }
        progress.accepted(record, report);
        return !interrupted();
      });
  if (!homogeneous) return std::nullopt;
  if (!job.quiet)
    for (const auto& lines : {watch.warnings(), result.warnings()})
      for (const std::string& line : lines) job.say("warning: {}", line);
  if (contact_watch && path.complete) {
    contact_watch->finish();
    for (const std::string& line : contact_watch->warnings()) job.say("warning: {}", line);
  }
  if (!unstable.empty())
    throw Failure(Exit::not_converged, Error{{},
                                             "",
                                             unstable,
                                             "a stable state (on_unstable: stop)",
                                             fmt::format("kept: the {} steps before in {}.part; on_unstable: warn goes on",
                                                         file.n_steps(), job.output)});
  if (!path.complete && interrupted())
    throw Failure(exit_code_of(interrupted()), Error{{},
                                                     "",
                                                     fmt::format("stopped by {} at t = {:.6g} after {} steps",
                                                                 signal_name(interrupted()), path.t, file.n_steps()),
                                                     "",
                                                     fmt::format("kept: {}.part (the next run continues from there)", job.output)});
  if (!path.complete)
    throw Failure(
        Exit::not_converged,
        Error{
            {},
            "",
            fmt::format("stopped at t = {:.6g} after {} steps: {}{}; smallest increment reached", path.t, file.n_steps(), path.why,
                        (statics.n_unstable() > 0 ? "; the body itself gives way (tangent not positive definite)" : "") +
                            (last_said.empty() ? "" : "; at the last state " + last_said) +
                            (held_by_contact.empty() ? "" : "; " + held_by_contact)),
            "",
            fmt::format("kept: {} steps in {}.part ({}", file.n_steps(), job.output,
                        held_by_contact.empty()
                            ? "the next run continues from there); try path.smallest or solver.newton.iterations"
                            : "a run of this config continues from there); hold also a node on the indenter's axis and, against "
                              "turning, one beside it, where contact does not: that begins anew")});
  std::vector<Summary> errors;
  if (config.estimate.value_or(EstimateBy::none) != EstimateBy::none) errors = say_errors(job, config, material, whole, mesh, last);
  std::vector<Summary> said = errors;  // of the result as a whole
  if (contact_watch)
    for (const Summary& s : contact_watch->summary()) said.push_back(s);
  // the processor's time before this function is that of loading the program
  file.finish(from_the_start ? std::optional(Cost{cpu_seconds(), wall_seconds() - began, 1e-6 * peak_bytes()}) : std::nullopt,
              said);
  progress.finished(path, statics, files);
  std::vector<Summary> summary = summary_of(file.n_steps(), path, statics);
  if (!scene.contacts.empty()) summary.push_back({"force", last.force_ind.norm(), "N"});
  for (const RigidContact& contact : scene.contacts)
    if (const auto found = last.scalars.find("force_" + contact.name); found != last.scalars.end())
      summary.push_back({"force_" + contact.name, found->second, "N"});
  if (rung) summary.push_back({"accuracy", rung->rung.error, "percent"});
  if (part && !mesh.section) summary.push_back({"symmetry", static_cast<double>(mesh.n_cells()) / body.mesh().n_cells(), "-"});
  if (point) summary.push_back({"homogeneous", static_cast<double>(mesh.n_cells()), "-"});
  summary.insert(summary.end(), said.begin(), said.end());
  summary.push_back({"fibre_jump", jump.degrees, "deg"});
  if (config.stability != StabilityCheck::off)
    for (const Summary& s : watch.summary()) summary.push_back(s);
  return summary;
}

std::vector<Summary> solve(const Job<SolveConfig>& job) {
  const SolveConfig& config = job.config;
  if (auto summary = solve_by(job, config.homogeneous == Homogeneous::automatic && config.stability == StabilityCheck::off))
    return *summary;
  job.say("homogeneous: the mesh no longer balances, and is solved from there on");
  return *solve_by(job, false);
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) { return langer::run_stage<langer::SolveConfig>(argc, argv, "solve", langer::solve); }
