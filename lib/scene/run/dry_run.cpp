#include "scene/run/dry_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "core/base/memory.hpp"
#include "core/base/say.hpp"
#include "core/base/stopwatch.hpp"
#include "mechanics/mesh/reference.hpp"
#include "scene/run/body_mesh.hpp"
#include "scene/run/motion_record.hpp"
#include "scene/run/step_record.hpp"

namespace langer {

namespace {

std::string friction_in_words(double mu) {
  return mu > 0 ? fmt::format("friction {:g}", mu) : "no friction";
}

// CPU seconds of one evaluation of the mortar integrals with their derivatives, from fingertip,
// liner, sliding_layers, fold and impact_two. A surface that touches itself, and bodies in motion,
// are out of contact for most of the path.
double seconds_of_surfaces(const Increment& increment, bool in_motion) {
  double seconds = 0;
  for (const SurfaceContact& surface : increment.surfaces()) {
    double of_a_node = 2.1e-4;
    if (in_motion) of_a_node = 0.7e-4;
    if (surface.touches_itself()) of_a_node = 0.1e-4;
    seconds += of_a_node * static_cast<double>(surface.nodes.size());
  }
  return seconds;
}

}  // namespace

std::string memory_in_words(double bytes) {
  if (bytes < 1e9) return fmt::format("{:.0f} MB", 1e-6 * bytes);
  return fmt::format("{:.1f} GB", 1e-9 * bytes);
}

std::string duration_in_words(double seconds) {
  if (seconds < 1) return fmt::format("{:.2g} s", seconds);
  if (seconds < 10) return fmt::format("{:.1f} s", seconds);
  if (seconds < 120) return fmt::format("{:.0f} s", seconds);
  if (seconds < 7200) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

void check_memory(const Increment& increment, const Increment* beside, int threads) {
  if (beside) check_memory(*beside, nullptr, threads);
  // OpenBLAS maps 134 MB a thread at its first product. If that fails, it tries again for ever.
  constexpr double blas = 135e6;
  const double factor = increment.size().factor_bytes;
  const double mapped = factor + blas * threads;
  const bool fits = factor <= free_memory() && mapped <= free_address();
  if (fits) return;
  double wanted = factor;
  if (factor <= free_memory()) wanted = mapped;
  const double free = std::min(free_memory(), free_address());
  throw Failure(
      Exit::config,
      Error{
          {},
          "",
          fmt::format(
              "this run needs {} more than the {} it holds already, for its tangent; {} are free",
              memory_in_words(wanted), memory_in_words(resident_bytes()), memory_in_words(free)),
          "",
          "a coarser or graded mesh, or a machine with more memory; --dry-run reports what a mesh takes"});
}

Forecast forecast_of(const SolveConfig& config, Assembler& body, const Increment& increment,
                     const Scene& scene) {
  const auto* newton = std::get_if<NewtonOptions>(&config.solver);
  CorrectionsBy by;
  by.reuses = newton && newton->reuse_tangent;
  by.in_tangent = increment.contact_in_tangent();
  by.mixed = increment.mixed();
  by.in_motion = config.in_motion();
  by.surfaces = seconds_of_surfaces(increment, by.in_motion);
  for (const SurfaceContact& surface : increment.surfaces()) {
    double touching = 1;  // share of the nodes at once
    if (surface.touches_itself()) touching = 0.3;
    by.surface_nodes += touching * static_cast<double>(surface.all_nodes.size());
  }
  LoadPathOptions path = config.path;
  if (scene.motion_step) path = motion_path(scene, path);
  Forecast out = forecast(body, increment.size(), increment.contacts(), path, scene.stops, by);
  // A frequency takes the stiffness of the viscous branches and a complex factor: measured.
  if (config.harmonic) {
    out.files +=
        2 * out.assembly * static_cast<double>(config.harmonic->frequencies.values().size());
  }
  return out;
}

Forecast forecast_of(const SolveConfig& config, const std::optional<Material>& material,
                     const Run::Where& where) {
  Run run(body_mesh(config, "", where), config, material, where);
  return forecast_of(config, run.body, run.increment, run.scene);
}

MeshChecks forecast_of_mesh(Run& run, const Increment* examined, StabilityCheck when) {
  Assembler* mesh = run.reduction.mesh_of_point();
  if (!mesh) return {};
  int steps = 0;
  std::optional<StepRecord> last;
  RunListener listener;
  listener.of_part = [&](StepRecord& record) {
    ++steps;
    last = record;
    return true;
  };
  // without a listener of the whole body nothing is put to the mesh but the last state
  run.follow(listener);
  std::optional<StepRecord> whole;
  if (last) whole = run.reduction.whole(*last);
  if (!whole) return {};
  int n_examined = 0;
  if (examined && when != StabilityCheck::off) n_examined = steps;
  if (examined && when == StabilityCheck::last) n_examined = 1;
  LinearSolver::Size size;
  if (examined) size = examined->size();
  return forecast_of_mesh(*mesh, size, state_of(*whole, run.scene).u, steps, n_examined);
}

std::vector<Summary> dry_run(const SolveConfig& config, const Scene& scene, Assembler& body,
                             const Increment& increment, const MeshChecks& checks, double estimate,
                             double spent, bool quiet) {
  const double free = std::min(free_memory(), free_address());
  Forecast f = forecast_of(config, body, increment, scene);
  f.files += spent + checks.seconds + checks.signatures * f.steps * (f.assembly + f.factor);
  if (!config.sensitivity.empty()) {  // a tangent of each state, and a solution for each number
    const auto numbers = static_cast<double>(config.sensitivity.size());
    f.files += f.steps * (f.assembly + f.factor + numbers * (2 * f.forces + f.solving));
  }
  // at the end the tangent of the state, and those of other symmetry
  if (checks.signatures == 0 && checks.seconds == 0 && config.stability != StabilityCheck::off &&
      !increment.iterative())
    f.files += 2 * (f.assembly + f.factor);
  f.bytes += checks.bytes;
  if (!quiet) {
    const auto line = [](const char* part, const std::string& says) {
      say_line("  {:<12}{}", part, says);
    };
    say_line("solve: dry run, nothing is solved or written");
    line("body",
         fmt::format("{} {}, {} nodes, {} free dofs, {}", body.mesh().n_cells(),
                     body.mesh().cell().names.shape, body.mesh().n_nodes(), body.dofs().n_free(),
                     names(body.formulation())[static_cast<int>(body.formulation())]));
    if (const Division* division = body.division())
      line("ranks", fmt::format("{} ranks, {} cells on this one; memory of all, time of each",
                                division->ranks->n(), body.own_cells().size()));
    std::string fibres = "off, not in the material";
    if (scene.families() == 1) fibres = "1 family";
    if (scene.families() > 1) fibres = fmt::format("{} families", scene.families());
    if (scene.families() > 0 && scene.directions.from_field()) {
      fibres += ", directions from a field";
    }
    line("fibres", fibres);
    if (body.viscous())
      line("viscous", fmt::format("branch stresses at the Gauss points take {} of the memory",
                                  memory_in_words(body.viscous_points()->bytes())));
    if (scene.contacts.empty() && scene.surfaces.empty()) line("contact", "off, not in the scene");
    for (const RigidContact& c : scene.contacts) {
      line("contact", fmt::format("{}: {} candidate nodes, {}", c.name, c.nodes.size(),
                                  friction_in_words(c.mu)));
    }
    for (const SurfaceContact& c : scene.surfaces) {
      line("contact", fmt::format("{}: {} candidate nodes against {} facets, {}", c.name,
                                  c.nodes.size(), c.other.size(), friction_in_words(c.mu)));
    }
    if (!scene.contacts.empty() || !scene.surfaces.empty())
      line("", increment.contact_in_tangent() ? "in the tangent itself"
                                              : "condensed to the candidates");
    line("solver", std::holds_alternative<KinsolOptions>(config.solver)
                       ? "kinsol; counted as newton"
                       : "newton");
    if (increment.iterative())
      line(
          "tangent",
          fmt::format(
              "{:.3g} million entries; solved iteratively, without a factor: the stability of equilibria is not looked at",
              1e-6 * f.size.nonzeros));
    else
      line("tangent",
           fmt::format("{:.3g} million entries; factor {:.3g} million, {:.3g} GFLOP",
                       1e-6 * f.size.nonzeros, 1e-6 * f.size.factor_nonzeros, 1e-9 * f.size.flops));
    std::string modified;
    if (f.again > 0) modified = fmt::format("Newton + {:.0f} modified ", f.again);
    std::string steps = "if none is cut back";
    if (f.bonds) steps = "with short ones while bonds let go";
    line("path", fmt::format("{} steps {}, about {:.0f} {}iterations", f.steps, steps, f.iterations,
                             modified));
    std::string memory =
        fmt::format("{}; {} are free", memory_in_words(f.bytes), memory_in_words(free));
    if (f.size.factor_bytes > free) memory += ": this will not fit";
    line("memory", memory);
    std::string contact_share;
    if (f.contact > 0) contact_share = fmt::format(", contact {:.2g}", f.contact);
    line(
        "time",
        fmt::format(
            "about {} of CPU; an iteration {:.2g} s: assembly {:.2g}, {} {:.2g}, solution {:.2g}{}",
            duration_in_words(f.seconds()), f.per_iteration() + f.contact, f.assembly,
            increment.iterative() ? "multigrid" : "factorization", f.factor, f.solving,
            contact_share));
    if (checks.seconds > 0)
      line("mesh", fmt::format("the states on the mesh take {} of CPU: balance {:.2g} s, points "
                               "{:.2g} s, factorization {:.2g} s each",
                               duration_in_words(checks.seconds), checks.assembly, checks.points,
                               checks.factor));
    if (estimate > 0)
      line("estimate",
           fmt::format("about {} of CPU more, on other meshes", duration_in_words(estimate)));
  }
  return {{"free_dofs", static_cast<double>(body.dofs().n_free()), "-"},
          {"cells", static_cast<double>(body.mesh().n_cells()), "-"},
          {"steps", static_cast<double>(f.steps), "-"},
          {"iterations", std::round(f.iterations), "-"},
          {"memory", 1e-6 * f.bytes, "MB"},
          {"memory_free", 1e-6 * free, "MB"},
          {"cpu", f.seconds() + estimate, "s"},
          {"cpu_iteration", f.per_iteration(), "s"}};
}

}  // namespace langer
