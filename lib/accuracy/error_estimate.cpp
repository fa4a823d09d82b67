#include "accuracy/error_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "assembly/equilibrium.hpp"
#include "base/interrupt.hpp"
#include "mesh/reference.hpp"
#include "post/fields.hpp"
#include "post/recovery.hpp"
#include "run/body_mesh.hpp"
#include "run/dry_run.hpp"
#include "tensor/stress.hpp"

namespace langer {

namespace {

// distances of nodes in contact radii
struct Lengths {
  double fine_enough;  // up to which errors follow the law (pipelines/estimates.yaml)
  double finest;       // of the meshes for coarser ones
};
constexpr Lengths of_block{0.18, 0.125}, of_disc{0.07, 0.0442};  // a disc has a line of nodes in contact: nothing averages
constexpr std::array longer{1.25, 1.5}, hex27_longer{std::numbers::sqrt2, 2.0};
constexpr double apart = 1.08, longest = 3;  // lengths of two meshes' cells, at least; the coarsest, at most
using Find = std::function<Place(const std::string&)>;

void set_increment(LoadPathOptions& path, double increment) {
  path.steps.reset();
  path.first = path.largest = increment;
}

double cells_along(const Geometry& geometry) {
  if (const auto* disc = std::get_if<IndentedDisc>(&geometry)) {
    const SectionBox section = disc->section();
    const auto n = section.instead.value_or(section.divisions);
    return std::sqrt(1.0 * n[0] * n[1]);
  }
  const Block block = std::get<IndentedBlock>(geometry).block();
  const auto n = block.instead.value_or(block.divisions);
  return std::cbrt(1.0 * n[0] * n[1] * n[2]);
}

// one scene on meshes whose cells differ by one factor everywhere
struct Family {
  std::vector<double> length;  // of cells, in those of the first
  std::vector<std::vector<Valued>> found;

  std::optional<double> of(std::size_t mesh, const std::string& name) const {
    for (const Valued& v : found[mesh])
      if (v.name == name) return v.value;
    return std::nullopt;
  }
};

struct Limit {
  double value;
  double scatter;  // root mean square of what the fit leaves
};
// f of q = f + A length^order, weights falling with the square of the length
std::optional<Limit> limit_of(const Family& family, const std::string& name, double order) {
  const auto n = static_cast<Eigen::Index>(family.length.size());
  VecX w(n), x(n), q(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto mesh = static_cast<std::size_t>(i);
    const std::optional<double> value = family.of(mesh, name);
    if (!value) return std::nullopt;
    w[i] = std::pow(family.length[mesh], -2), x[i] = std::pow(family.length[mesh], order), q[i] = *value;
  }
  w /= w.sum();
  const double x_mean = w.dot(x), q_mean = w.dot(q);
  const VecX dx = x.array() - x_mean, dq = q.array() - q_mean;
  const double A = w.dot(dx.cwiseProduct(dq)) / w.dot(dx.cwiseProduct(dx));
  const VecX left = dq - A * dx;
  return Limit{q_mean - A * x_mean, std::sqrt(w.dot(left.cwiseProduct(left)))};
}

// what an estimate solves
struct Refinements {
  std::vector<SolveConfig> hex8, hex27;  // without what is known
  std::vector<double> length;            // of the hex8 meshes' cells, `own` included
  bool own = false;                      // the solved mesh is the finest of its family
  SolveConfig other_increments;
  double per_change = 0;  // error of the increments per what these change; 0: none, the path does not matter
  int n_scenes() const { return static_cast<int>(hex8.size() + hex27.size()) + (per_change != 0); }
};

Refinements refinements(const SolveConfig& config, const Find& where) {
  if (!config.mesh || !has_edge_in_contact_radii(config.mesh->geometry))
    throw Failure(Exit::config, Error{where("estimate"), "estimate",
                                      "the mesh is not an indented_block or indented_disc of this config", "", ""});
  Refinements refined;
  SolveConfig other = config;
  Geometry& geometry = other.mesh->geometry;
  const double edge = *edge_in_contact_radii(geometry);
  const Lengths lengths = is_section(geometry) ? of_disc : of_block;
  const bool quadratic = reference(config.mesh->cells).second_order();
  const bool locks = config.formulation == Formulation::displacement;  // and with it its limit on such cells
  refined.own = !quadratic && !locks && edge <= lengths.fine_enough;
  if (!refined.own) {
    other.mesh->cells = CellType::hex8;
    other.formulation.reset();
    *edge_in_contact_radii(geometry) = std::min(quadratic ? 0.5 * edge : edge, lengths.finest);
    refined.hex8.push_back(other);
  }
  refined.length = {1};
  const double cells = cells_along(geometry);
  for (double factor : longer) {
    do *longer_cells(geometry) = factor;  // a few layers may be divided by two factors alike
    while (cells / cells_along(geometry) < apart * refined.length.back() && (factor *= 1.1) < longest);
    if (factor >= longest)
      throw Failure(Exit::not_converged,
                    Error{where("estimate"), "estimate", "too few cells to make coarser meshes from them", "shorter cells", ""});
    refined.length.push_back(cells / cells_along(geometry));
    refined.hex8.push_back(other);
  }
  if (has_friction(config)) {
    const double increment = config.path.steps ? 1.0 / *config.path.steps : config.path.largest;
    refined.per_change = increment > 0.5 ? -1 : 1.0 / 3;
    set_increment(other.path, increment > 0.5 ? 0.5 * increment : 2 * increment);
    refined.other_increments = other;
  }
  for (double factor : hex27_longer) {
    if (!quadratic) continue;
    refined.hex27.push_back(config);
    *edge_in_contact_radii(refined.hex27.back().mesh->geometry) = factor * edge;
  }
  return refined;
}

// A rigid face presses an edge into the body, its own or the body's: there stresses are singular, and errors fall with h alone.
double order_of_force(const SolveConfig& config) {
  return std::any_of(config.contacts.begin(), config.contacts.end(),
                     [](const auto& contact) {
                       return std::holds_alternative<Plane>(contact.second.rigid) ||
                              std::holds_alternative<Cylinder>(contact.second.rigid);
                     })
             ? 1
             : 2;
}

Vec3 force_of(const StepRecord& state, const std::string& contact) {
  Vec3 force;
  for (int j = 0; j < 3; ++j) force[j] = state.scalars.at("force_" + contact + "_" + "xyz"[j]);
  return force;
}

}  // namespace

std::vector<Valued> end_of_path(const SolveConfig& config, const std::optional<Material>& material, const Find& where,
                                const std::function<RunListener(const Run&)>& listener) {
  Run run(body_mesh(config, "", where), config, material, where);
  const RunEnd end = run.follow(listener ? listener(run) : RunListener{});
  if (end.at == RunEnd::At::signal)
    throw Failure(exit_code_of(interrupted()), Error{{}, "", fmt::format("stopped by {}", signal_name(interrupted())), "", ""});
  if (!end.path.complete)
    throw Failure(Exit::not_converged, Error{{},
                                             "",
                                             fmt::format("the solve with the refined mesh found no equilibrium at t = {:.6g}: {}",
                                                         end.path.t, end.path.why),
                                             "",
                                             ""});
  return valued(run.scene, run.mesh, end.last);
}

std::vector<Valued> valued(const Scene& scene, const Mesh& mesh, const StepRecord& state) {
  std::vector<Valued> found;
  if (!scene.contacts.empty()) found.push_back({"force", "N", state.force_ind.norm()});
  if (scene.contacts.size() > 1)
    for (const RigidContact& contact : scene.contacts)
      found.push_back({"force_" + contact.name, "N", force_of(state, contact.name).norm()});
  const Body body(mesh, scene.materials, scene.directions, scene.formulation);
  const GaussValues gauss = gauss_values(body, state.u);
  double most = 0;
  for (int n = 0; n < mesh.n_nodes(); ++n)
    most = std::max(most, von_mises(sigma_of(node_values(body, n, gauss, StressAt::nodal_average))));
  found.push_back({"von_mises_max", "MPa", most});
  for (const auto& [name, nodes] : mesh.node_sets)
    if (nodes.size() == 1) found.push_back({"displacement_" + name, "mm", state.u[static_cast<std::size_t>(nodes[0])].norm()});
  return found;
}

std::vector<ErrorEstimate> recovered_errors(const Scene& scene, const Mesh& mesh, const StepRecord& state,
                                            const std::vector<Valued>& found) {
  const RecoveredError error = recovered_error(Body(mesh, scene.materials, scene.directions, scene.formulation), state.u);
  std::vector<ErrorEstimate> estimates;
  for (const Valued& q : found) {
    const double cells = q.of_force() ? error.energy_share() * q.value : q.name == "von_mises_max" ? error.von_mises_spread : -1;
    if (cells >= 0) estimates.push_back({q, cells, 0, 0, state.residual * std::abs(q.value), 2, false});
  }
  return estimates;
}

std::vector<ErrorEstimate> estimate_errors(const SolveConfig& config, const std::optional<Material>& material, const Find& where,
                                           const std::vector<Valued>& found, double residual, const EstimateListener& listener) {
  const Refinements refined = refinements(config, where);
  int begun = 0;
  const auto solved = [&](const std::vector<SolveConfig>& scenes, Family family) {
    for (const SolveConfig& scene : scenes) {
      ++begun;
      family.found.push_back(end_of_path(scene, material, where, [&](const Run& run) {
        return listener ? listener(run, begun, refined.n_scenes()) : RunListener{};
      }));
    }
    return family;
  };
  const std::vector<std::vector<Valued>> itself{found}, nothing;
  const Family family = solved(refined.hex8, {refined.length, refined.own ? itself : nothing});
  // stresses and what lies far from the contact are those of the cells: meshes of the same kind
  const Family alike = refined.hex27.empty() ? family : solved(refined.hex27, {{1, hex27_longer[0], hex27_longer[1]}, itself});
  const Family path = refined.per_change == 0 ? Family{} : solved({refined.other_increments}, {{}, {family.found.back()}});

  std::vector<ErrorEstimate> estimates;
  for (const Valued& q : found) {
    const bool force = q.of_force();
    const double order = force ? order_of_force(config) : q.name == "von_mises_max" ? 1 : 2;
    const auto limit = limit_of(force ? family : alike, q.name, order);
    if (!limit) continue;
    double increments = 0;
    if (!path.found.empty()) increments = refined.per_change * (path.of(1, q.name).value_or(0) - path.of(0, q.name).value_or(0));
    estimates.push_back({q, q.value - limit->value, increments, limit->scatter, residual * std::abs(q.value), order});
  }
  return estimates;
}

std::vector<ErrorEstimate> estimated(const SolveConfig& config, const std::optional<Material>& material, const Find& where,
                                     const Run& run, const StepRecord& last, const EstimateListener& listener) {
  const std::vector<Valued> found = valued(run.scene, run.mesh, last);
  if (config.estimate == EstimateBy::recovery) return recovered_errors(run.scene, run.mesh, last, found);
  return estimate_errors(config, material, where, found, last.residual, listener);
}

std::string in_words(const ErrorEstimate& e) {
  const std::string begins = fmt::format("{} {:.4g} {} +- {:.2g} %", e.of.name, e.of.value, e.of.unit, e.in_percent(e.total()));
  const double cells = e.in_percent(e.cells), solver = e.in_percent(e.solver);
  if (!e.has_limit) return fmt::format("{} (cells {:.2g} by recovery, solver {:.1g} %)", begins, cells, solver);
  return fmt::format("{} (cells {:+.2g}, increments {:+.2g}, scatter {:.2g}, solver {:.1g} %); limit {:.4g}", begins, cells,
                     e.in_percent(e.increments), e.in_percent(e.scatter), solver, e.limit());
}

std::vector<Summary> summary_of(const std::vector<ErrorEstimate>& estimates) {
  std::vector<Summary> summary;
  for (const ErrorEstimate& e : estimates) {
    const auto add = [&](const char* what, double value) { summary.push_back({e.of.name + what, value, e.of.unit}); };
    add("_error", e.total()), add("_error_cells", e.cells);
    if (e.has_limit) add("_limit", e.limit()), add("_error_increments", e.increments), add("_error_scatter", e.scatter);
    add("_error_solver", e.solver);
  }
  return summary;
}

double estimate_seconds(const SolveConfig& config, const std::optional<Material>& material, const Find& where) {
  if (config.estimate != EstimateBy::refinement) return 0;
  const Refinements refined = refinements(config, where);
  const auto seconds = [&](const SolveConfig& scene) {
    Run run(body_mesh(scene, "", where), scene, material, where);
    return forecast_of(scene, run.body, run.statics, run.scene.stops).seconds();
  };
  double sum = refined.per_change == 0 ? 0 : seconds(refined.other_increments);
  for (const auto* scenes : {&refined.hex8, &refined.hex27})
    for (const SolveConfig& scene : *scenes) sum += seconds(scene);
  return sum;
}

}  // namespace langer
