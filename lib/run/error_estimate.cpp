#include "run/error_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "assembly/equilibrium.hpp"
#include "post/fields.hpp"
#include "post/recovery.hpp"
#include "run/dry_run.hpp"
#include "run/equilibrium_by.hpp"
#include "run/step_record.hpp"
#include "scene/make_mesh.hpp"
#include "scene/symmetry.hpp"
#include "solve/load_path.hpp"
#include "solve/statics.hpp"
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
struct SecondRungs {
  std::vector<SolveConfig> hex8, hex27;  // without what is known
  std::vector<double> length;            // of the hex8 meshes' cells, `own` included
  bool own = false;                      // the solved mesh is the finest of its family
  SolveConfig other_increments;
  double per_change = 0;  // error of the increments per what these change; 0: none, the path does not matter
};

SecondRungs second_rungs(const SolveConfig& config, const Find& where) {
  if (!config.mesh || !has_edge_in_contact_radii(config.mesh->geometry))
    throw Failure(Exit::config, Error{where("estimate"), "estimate",
                                      "the mesh is not an indented_block or indented_disc of this config", "", ""});
  SecondRungs rungs;
  SolveConfig other = config;
  Geometry& geometry = other.mesh->geometry;
  const double edge = *edge_in_contact_radii(geometry);
  const Lengths lengths = is_section(geometry) ? of_disc : of_block;
  const bool quadratic = config.mesh->cells == CellType::hex27;
  const bool locks = config.formulation == Formulation::displacement;  // and with it its limit on such cells
  rungs.own = !quadratic && !locks && edge <= lengths.fine_enough;
  if (!rungs.own) {
    other.mesh->cells = CellType::hex8;
    other.formulation.reset();
    *edge_in_contact_radii(geometry) = std::min(quadratic ? 0.5 * edge : edge, lengths.finest);
    rungs.hex8.push_back(other);
  }
  rungs.length = {1};
  const double cells = cells_along(geometry);
  for (double factor : longer) {
    *longer_cells(geometry) = factor;
    rungs.length.push_back(cells / cells_along(geometry));
    rungs.hex8.push_back(other);
  }
  if (has_friction(config)) {
    const double increment = config.path.steps ? 1.0 / *config.path.steps : config.path.largest;
    rungs.per_change = increment > 0.5 ? -1 : 1.0 / 3;
    set_increment(other.path, increment > 0.5 ? 0.5 * increment : 2 * increment);
    rungs.other_increments = other;
  }
  for (double factor : hex27_longer) {
    if (!quadratic) continue;
    rungs.hex27.push_back(config);
    *edge_in_contact_radii(rungs.hex27.back().mesh->geometry) = factor * edge;
  }
  return rungs;
}

// act(mesh, scene, what symmetry leaves, equilibrium, statics) of a config that holds its mesh
auto with_scene(const SolveConfig& config, const std::optional<Material>& material, const Find& where, auto act) {
  const Mesh mesh = make_mesh(*config.mesh, [](const std::string&) { return Place{}; }).mesh;
  const Scene whole = make_scene(config, mesh, material, where);
  const std::optional<ReducedScene> part = ReducedScene::find(config.symmetry, mesh, whole, where);
  Equilibrium body = equilibrium_of(mesh, whole, part, config.threads);
  StaticsOptions options;
  options.threads = config.blas_threads;
  Statics statics(body, (part ? part->scene() : whole).contacts, options);
  return act(mesh, whole, part, body, statics);
}

Body body_of(const Scene& scene, const Mesh& mesh) {
  std::vector<std::vector<Vec3>> fibres(static_cast<std::size_t>(mesh.n_cells()));
  for (int e = 0; e < mesh.n_cells(); ++e) fibres[static_cast<std::size_t>(e)] = scene.fibres_of(mesh, e);
  return {mesh, scene.materials, scene.formulation, fibres};
}

}  // namespace

std::vector<Valued> end_of_path(const SolveConfig& config, const std::optional<Material>& material, const Find& where) {
  return with_scene(
      config, material, where,
      [&](const Mesh& mesh, const Scene& whole, const std::optional<ReducedScene>& part, Equilibrium& body, Statics& statics) {
        StepRecord last;
        const PathReport path = load_path(
            config.path, 0, std::nullopt, whole.stops,
            [&](double t) {
              statics.begin(t);
              return equilibrium_by(config.solver, statics);
            },
            [&](double t, double taken, double next, const SolveReport& report) {
              statics.accept();
              if (t >= 1 - 1e-10) last = step_record(statics, body, taken, next, report);
              return true;
            });
        if (!path.complete)
          throw Failure(
              Exit::not_converged,
              Error{{},
                    "",
                    fmt::format("the solve with the refined mesh found no equilibrium at t = {:.6g}: {}", path.t, path.why),
                    "",
                    ""});
        return valued(whole, mesh, part ? part->whole(last) : last);
      });
}

std::vector<Valued> valued(const Scene& scene, const Mesh& mesh, const StepRecord& state) {
  std::vector<Valued> found;
  if (!scene.contacts.empty()) found.push_back({"force", "N", state.force_ind.norm()});
  const Body body = body_of(scene, mesh);
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
  const RecoveredError error = recovered_error(body_of(scene, mesh), state.u);
  std::vector<ErrorEstimate> estimates;
  for (const Valued& q : found) {
    const double cells = q.name == "force"           ? error.energy_share() * q.value
                         : q.name == "von_mises_max" ? error.von_mises_spread
                                                     : -1;
    if (cells >= 0) estimates.push_back({q, cells, 0, 0, state.residual * std::abs(q.value), false});
  }
  return estimates;
}

std::vector<ErrorEstimate> estimate_errors(const SolveConfig& config, const std::optional<Material>& material, const Find& where,
                                           const std::vector<Valued>& found, double residual) {
  const SecondRungs rungs = second_rungs(config, where);
  const auto solved = [&](const std::vector<SolveConfig>& scenes, Family family) {
    for (const SolveConfig& scene : scenes) family.found.push_back(end_of_path(scene, material, where));
    return family;
  };
  const std::vector<std::vector<Valued>> itself{found}, nothing;
  const Family family = solved(rungs.hex8, {rungs.length, rungs.own ? itself : nothing});
  // stresses and what lies far from the contact are those of the cells: meshes of the same kind
  const Family alike = rungs.hex27.empty() ? family : solved(rungs.hex27, {{1, hex27_longer[0], hex27_longer[1]}, itself});
  const Family path = rungs.per_change == 0 ? Family{} : solved({rungs.other_increments}, {{}, {family.found.back()}});

  std::vector<ErrorEstimate> estimates;
  for (const Valued& q : found) {
    const auto limit = q.name == "force" ? limit_of(family, q.name, 2) : limit_of(alike, q.name, q.name == "von_mises_max" ? 1 : 2);
    if (!limit) continue;
    double increments = 0;
    if (!path.found.empty()) increments = rungs.per_change * (path.of(1, q.name).value_or(0) - path.of(0, q.name).value_or(0));
    estimates.push_back({q, q.value - limit->value, increments, limit->scatter, residual * std::abs(q.value)});
  }
  return estimates;
}

double estimate_seconds(const SolveConfig& config, const std::optional<Material>& material, const Find& where) {
  const SecondRungs rungs = second_rungs(config, where);
  const auto seconds = [&](const SolveConfig& scene) {
    return with_scene(scene, material, where,
                      [&](const Mesh&, const Scene& whole, const auto&, Equilibrium& body, Statics& statics) {
                        return forecast_of(scene, body, statics, whole.stops).seconds();
                      });
  };
  double sum = rungs.per_change == 0 ? 0 : seconds(rungs.other_increments);
  for (const auto* scenes : {&rungs.hex8, &rungs.hex27})
    for (const SolveConfig& scene : *scenes) sum += seconds(scene);
  return sum;
}

}  // namespace langer
