#include "accuracy/checks/progress.hpp"

#include <algorithm>

#include "core/base/interrupt.hpp"
#include "core/base/memory.hpp"
#include "core/base/say.hpp"
#include "core/base/stopwatch.hpp"
#include "core/base/text.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

namespace {

// "3 Newton + 4 modified iterations": modified Newton keeps an older tangent
std::string iterations(int newton, int modified) {
  if (modified > 0) {
    return fmt::format("{} Newton + {} modified iterations", newton, modified);
  }
  return fmt::format("{} iterations", newton);
}

// The forces on the indenters by name: in a pinch their sum is zero and says nothing.
std::string forces_of(const StepRecord& record) {
  std::string each;
  for (const auto& [name, contact] : record.contacts)
    if (const auto found = record.scalars.find("force_" + name); found != record.scalars.end())
      append(each, ", ", fmt::format("{} {:.5g}", name, found->second));
  if (each.empty()) return fmt::format("{:.5g}", record.force_ind.norm());
  return each;
}

// Iterations are shown in the status line of a terminal only; a file would collect them all.
bool rewrites(const Voice& voice) { return on_terminal() && !voice.verbose; }

// The size of the model, for the first line of a run.
std::string sizes(const Run& run) {
  const Mesh& mesh = run.body.mesh();
  return fmt::format("{} {}, {} nodes, {} free dofs, {}", mesh.n_cells(), mesh.cell().names.shape,
                     mesh.n_nodes(), run.body.dofs().n_free(),
                     names(run.body.formulation())[static_cast<int>(run.body.formulation())]);
}

// The residual relative to its reference force, or absolute [N] where there is no force yet. A
// state with a folded element has no residual.
std::string residual_of(const Assessment& found) {
  if (!found.admissible) return "not admissible";
  double residual = found.residual;
  if (found.reference > 0) residual /= found.reference;
  return fmt::format("{:.1e}", residual);
}

// With -v a line for each iteration, otherwise one status line that is rewritten.
void say_iteration(const Voice& voice, double t, int n, const Assessment& found,
                   const std::string& status) {
  if (!voice.verbose) {
    say_status(status);
    return;
  }
  std::string line = fmt::format("  t {:.4f}  iteration {}  residual {}", t, n, residual_of(found));
  if (!found.missing.empty()) line += "  " + found.missing;
  say_line("{}", line);
}

}  // namespace

Progress::Progress(const Voice& voice, const Run& run)
    : voice_(voice),
      live_(rewrites(voice)),
      contact_(!run.scene.contacts.empty()),
      start_(wall_seconds()) {
  const Scene& scene = run.reduction.scene();
  std::string families = "none";
  if (scene.families() > 0) families = std::to_string(scene.families());
  std::string contacts = "none";
  if (!scene.contacts.empty()) contacts = std::to_string(scene.contacts.size());
  std::string ranks;
  if (run.shared_by()) ranks = fmt::format("; {} ranks", run.shared_by()->n());
  voice_.detail("{}; fibre families: {}; contacts: {}{}", sizes(run), families, contacts, ranks);
}

// A continued run counts its remaining time from where it continues.
void Progress::resumed(int steps, double t) {
  from_ = t;
  step_ = steps;
  voice_.say("continues after {} steps, at t = {:.6g}", steps, t);
}

// The remaining time, if the rest of the path takes as long per t as the steps so far.
std::string Progress::left(double t) const {
  if (at_end_of_path(t) || t <= from_) return "";
  const double seconds = (wall_seconds() - start_) * (1 - t) / (t - from_);
  if (seconds < 100) return fmt::format("  {:.0f} s remaining", seconds);
  if (seconds < 6000) return fmt::format("  {:.0f} min remaining", seconds / 60);
  return fmt::format("  {:.1f} h remaining", seconds / 3600);
}

// Wraps the problem of one increment so that each assessment of a state is shown. The iteration
// counts from 0, the predicted state. Where nothing would be shown the problem is returned as it
// is.
Problem Progress::watched(Problem problem, double t) {
  if (voice_.quiet || (!voice_.verbose && !live_)) return problem;
  problem.assess = [this, t, n = 0, assess = std::move(problem.assess)](const VecX& x,
                                                                        bool with_tangent) mutable {
    const Assessment found = assess(x, with_tangent);
    say_iteration(voice_, t, n, found,
                  fmt::format("step {:3d}  t {:.4f}  iteration {}  residual {}{}", step_ + 1, t, n,
                              residual_of(found), left(t)));
    ++n;
    return found;
  };
  return problem;
}

// The same for the additional computations of an error estimate, which also end when the user
// interrupts: an assessment that is not admissible stops the iteration.
RunListener estimate_progress(const Voice& voice, const Run& run, int n, int of) {
  const std::string who = fmt::format("errors: scene {} of {}", n, of);
  voice.progress(who + ", " + sizes(run));
  RunListener listener;
  listener.watched = [voice, who, seen = !voice.quiet && (voice.verbose || rewrites(voice))](
                         Problem problem, double t) {
    problem.assess = [voice, who, seen, t, k = 0, assess = std::move(problem.assess)](
                         const VecX& x, bool with_tangent) mutable {
      if (interrupted()) return Assessment{.admissible = false, .missing = "stopped"};
      const Assessment found = assess(x, with_tangent);
      if (seen)
        say_iteration(
            voice, t, k, found,
            fmt::format("{}  t {:.4f}  iteration {}  residual {}", who, t, k, residual_of(found)));
      ++k;
      return found;
    };
    return problem;
  };
  return listener;
}

// One line for each step that was found: the load, the effort, and the quality of the state. An
// unstable state is always printed. NaN counts as unstable, hence the negated comparison.
void Progress::accepted(const StepRecord& record, const SolveReport& report) {
  ++step_;
  if (voice_.quiet) return;
  bool unstable = false;
  std::string line = fmt::format("step {:3d}  t {:.4f}", step_, record.t);
  if (contact_)
    line += fmt::format("  u_ind {:.4f} mm  force {} N", record.u_ind.norm(), forces_of(record));
  line += fmt::format("  {}  residual {:.1e}{}", iterations(report.iterations, report.again),
                      record.residual, left(record.t));
  const std::string brief = line;
  line += fmt::format("  J_min {:.4f}", record.scalars.at("J_min"));
  if (const auto stiffness = record.scalars.find("shear_stiffness_min");
      stiffness != record.scalars.end()) {
    const double negative = value_or(record.scalars, "negative_eigenvalues", 0.0);
    line += fmt::format("  min acoustic eigenvalue {:.3g} MPa", stiffness->second);
    unstable = negative != 0 || !(stiffness->second >= 0);
    if (negative > 0) line += fmt::format("  UNSTABLE: {:.0f} negative eigenvalues", negative);
    if (negative < 0) line += "  UNSTABLE: singular tangent";
    if (!(stiffness->second >= 0)) line += "  MATERIAL UNSTABLE";
  }
  if (contact_) {
    int stick = 0, slip = 0;
    for (const auto& [name, contact] : record.contacts)
      for (int status : contact.status) {
        stick += status == 1;
        slip += status == 2;
      }
    line += fmt::format(
        "  stick {} slip {}  penetration {:.1e} mm  cone {:.1e}  complementarity {:.1e}", stick,
        slip, record.scalars.at("penetration"), record.scalars.at("cone"),
        record.scalars.at("complementarity"));
  }
  if (unstable) {
    say_line(line);
  } else {
    progress_line(brief, line, voice_.verbose);
  }
}

// A jump may pass through many equilibria at the same t: a message every ten seconds shows that the
// program still works.
void Progress::jumping(double t, int equilibria) {
  constexpr double between = 10;  // s
  if (equilibria == 0) said_ = wall_seconds();
  if (wall_seconds() - said_ < between) return;
  said_ = wall_seconds();
  voice_.say("t = {:.6g}: bonds of the adhesion let go in a jump, {} equilibria followed so far", t,
             equilibria);
}

void Progress::failed(double t, const SolveReport& report) const {
  voice_.detail("no equilibrium found at t = {:.6g}: {}; the increment is halved", t, report.why);
}

// Totals of a run: steps, memory, and where the CPU time was spent.
void Progress::finished(const PathReport& path, const Increment& increment, double files) const {
  const Increment::Cost cost = increment.cost();
  voice_.say("{} steps, {}, {} step cut-backs; {:.0f} MB", path.steps,
             iterations(path.iterations, path.again), path.cut_backs, 1e-6 * peak_bytes());
  voice_.detail(
      "CPU s: analysis {:.2f}, assembly {:.2f}, factor {:.2f} ({:.1f} GFLOP/s), solve {:.2f}, contact {:.2f}, "
      "files {:.2f}",
      cost.analysis, cost.assembly, cost.factor,
      1e-9 * increment.size().flops * static_cast<double>(cost.factorizations) /
          std::max(cost.factor, 1e-9),
      cost.solve, cost.contact, files);
  if (increment.n_indefinite() > 0)
    voice_.detail(
        "{} tangents of iterations, before equilibrium, were not positive definite; this is no statement about "
        "the states found, which stability: each_step examines",
        increment.n_indefinite());
}

}  // namespace langer
