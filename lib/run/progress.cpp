#include "run/progress.hpp"

#include <algorithm>

#include "base/memory.hpp"
#include "base/say.hpp"
#include "base/stopwatch.hpp"

namespace langer {

Progress::Progress(bool quiet, bool verbose, const Equilibrium& body, const Scene& scene)
    : quiet_(quiet),
      verbose_(verbose),
      live_(on_terminal() && !verbose && !said::log),
      contact_(!scene.contacts.empty()),
      start_(wall_seconds()) {
  if (quiet_) return;
  const int families = scene.families();
  say_line("solve: {} {}, {} nodes, {} free dofs, {}; fibre families: {}; contacts: {}", body.mesh().n_cells(),
           shape_name(body.mesh().type), body.mesh().n_nodes(), body.dofs().n_free(),
           names(body.formulation())[static_cast<int>(body.formulation())], families == 0 ? "none" : std::to_string(families),
           scene.contacts.empty() ? "none" : std::to_string(scene.contacts.size()));
}

void Progress::resumed(int steps, double t) {
  from_ = t, step_ = steps;
  if (!quiet_) say_line("solve: continues after {} steps, at t = {:.6g}", steps, t);
}

namespace {

// "3 Newton + 4 modified iterations": modified Newton keeps an older tangent
std::string iterations(int newton, int modified) {
  return modified > 0 ? fmt::format("{} Newton + {} modified iterations", newton, modified) : fmt::format("{} iterations", newton);
}

}  // namespace

// what the rest takes if it goes on as so far
std::string Progress::left(double t) const {
  if (t >= 1 - 1e-10 || t <= from_) return "";
  const double seconds = (wall_seconds() - start_) * (1 - t) / (t - from_);
  if (seconds < 100) return fmt::format("  {:.0f} s remaining", seconds);
  return seconds < 6000 ? fmt::format("  {:.0f} min remaining", seconds / 60) : fmt::format("  {:.1f} h remaining", seconds / 3600);
}

Problem Progress::watched(Problem problem, double t) {
  if (quiet_ || (!verbose_ && !live_)) return problem;
  int n = 0;
  problem.assess = [this, t, n, assess = std::move(problem.assess)](const VecX& x, bool with_tangent) mutable {
    const Assessment found = assess(x, with_tangent);
    const std::string residual =
        found.admissible ? fmt::format("{:.1e}", found.reference > 0 ? found.residual / found.reference : found.residual)
                         : "not admissible";
    if (verbose_)
      say_line("  t {:.4f}  iteration {}  residual {}{}{}", t, n, residual, found.missing.empty() ? "" : "  ", found.missing);
    else
      say_status(fmt::format("step {:3d}  t {:.4f}  iteration {}  residual {}{}", step_ + 1, t, n, residual, left(t)));
    ++n;
    return found;
  };
  return problem;
}

void Progress::accepted(const StepRecord& record, const SolveReport& report) {
  ++step_;
  if (quiet_) return;
  bool unstable = false;
  std::string line = fmt::format("step {:3d}  t {:.4f}", step_, record.t);
  if (contact_) line += fmt::format("  u_ind {:.4f} mm  force {:.5g} N", record.u_ind.norm(), record.force_ind.norm());
  line += fmt::format("  {}  residual {:.1e}{}", iterations(report.iterations, report.again), record.residual, left(record.t));
  if (live_) say_status(line);
  line += fmt::format("  J_min {:.4f}", record.scalars.at("J_min"));
  if (const auto stiffness = record.scalars.find("shear_stiffness_min"); stiffness != record.scalars.end()) {
    const double negative = record.scalars.at("negative_eigenvalues");
    line += fmt::format("  min acoustic eigenvalue {:.3g} MPa", stiffness->second);
    unstable = negative != 0 || !(stiffness->second >= 0);
    if (negative > 0) line += fmt::format("  UNSTABLE: {:.0f} negative eigenvalues", negative);
    if (negative < 0) line += "  UNSTABLE: singular tangent";
    if (!(stiffness->second >= 0)) line += "  MATERIAL UNSTABLE";
  }
  if (contact_) {
    int stick = 0, slip = 0;
    for (const auto& [name, contact] : record.contacts)
      for (int status : contact.status) stick += status == 1, slip += status == 2;
    line += fmt::format("  stick {} slip {}  penetration {:.1e} mm  cone {:.1e}  complementarity {:.1e}", stick, slip,
                        record.scalars.at("penetration"), record.scalars.at("cone"), record.scalars.at("complementarity"));
  }
  if (!live_ || unstable) say_line(line);
}

void Progress::failed(double t, const SolveReport& report) const {
  if (!quiet_) say_line("solve: no equilibrium found at t = {:.6g}: {}; the increment is halved", t, report.why);
}

void Progress::finished(const PathReport& path, const Statics& statics, double files) const {
  if (quiet_) return;
  const Statics::Cost& cost = statics.cost();
  say_line("solve: {} steps, {}, {} step cut-backs; {:.0f} MB", path.steps, iterations(path.iterations, path.again), path.cuts,
           1e-6 * peak_bytes());
  say_line(
      "solve: CPU s: analysis {:.2f}, assembly {:.2f}, factor {:.2f} ({:.1f} GFLOP/s), solve {:.2f}, contact {:.2f}, "
      "files {:.2f}",
      cost.analysis, cost.assembly, cost.factor,
      1e-9 * statics.linear().size().flops * static_cast<double>(cost.factorizations) / std::max(cost.factor, 1e-9), cost.solve,
      cost.contact, files);
  if (statics.n_indefinite() > 0)
    say_line(
        "solve: {} tangents were not positive definite: without its constraints the body is unstable in some direction "
        "(limit point, loss of ellipticity, or too few supports)",
        statics.n_indefinite());
}

}  // namespace langer
