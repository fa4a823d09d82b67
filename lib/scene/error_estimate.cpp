#include "scene/error_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assembly/equilibrium.hpp"
#include "post/fields.hpp"
#include "post/recovery.hpp"
#include "scene/equilibrium_by.hpp"
#include "scene/make_mesh.hpp"
#include "scene/step_record.hpp"
#include "scene/symmetry.hpp"
#include "solve/load_path.hpp"
#include "solve/statics.hpp"
#include "tensor/stress.hpp"

namespace langer {

namespace {

constexpr double ratio = 1.4142135623730951;

void set_increment(LoadPathOptions& path, double increment) {
  path.steps.reset();
  path.first = path.largest = increment;
}

struct Fitted {
  double cells;    // A h^p of the finest
  double scatter;  // root mean square of what is left
};
// of values on cells of h, ratio h and ratio^2 h, weighted 4, 2, 1
Fitted fit(const Vec3& values, double order) {
  const double falls = std::pow(ratio, order);
  const Vec3 x(1, falls, falls * falls), w = Vec3(4, 2, 1) / 7;
  const double x_mean = w.dot(x), mean = w.dot(values);
  const Vec3 dx = x.array() - x_mean, dv = values.array() - mean;
  const double A = w.dot(dx.cwiseProduct(dv)) / w.dot(dx.cwiseProduct(dx));
  const Vec3 left = dv - A * dx;
  return {A, std::sqrt(w.dot(left.cwiseProduct(left)))};
}

Body body_of(const Scene& scene, const Mesh& mesh) {
  std::vector<std::vector<Vec3>> fibres(static_cast<std::size_t>(mesh.n_cells()));
  for (int e = 0; e < mesh.n_cells(); ++e) fibres[static_cast<std::size_t>(e)] = scene.fibres_of(mesh, e);
  return {mesh, scene.materials, scene.formulation, fibres};
}

}  // namespace

std::vector<Valued> end_of_path(const SolveConfig& config, const std::optional<Material>& material,
                                const std::function<Place(const std::string&)>& where) {
  const Mesh mesh = make_mesh(*config.mesh, [](const std::string&) { return Place{}; }).mesh;
  const Scene whole = make_scene(config, mesh, material, where);
  const std::optional<ReducedScene> part = ReducedScene::find(config.symmetry, mesh, whole, where);
  const Scene& scene = part ? part->scene() : whole;
  Equilibrium body = equilibrium_of(mesh, whole, part, config.threads);
  StaticsOptions options;
  options.threads = config.blas_threads;
  Statics statics(body, scene.contacts, options);
  StepRecord last;
  const PathReport path = load_path(
      config.path, 0, std::nullopt, scene.stops,
      [&](double t) {
        statics.begin(t);
        return equilibrium_by(config.solver, statics.problem(), statics.trial());
      },
      [&](double t, double taken, double next, const SolveReport& report) {
        statics.accept();
        if (t >= 1 - 1e-10) last = step_record(statics, body, taken, next, report);
        return true;
      });
  if (!path.complete)
    throw Failure(Exit::not_converged,
                  Error{{}, "", fmt::format("a second rung found no equilibrium at t = {:.6g}: {}", path.t, path.why), "", ""});
  return valued(whole, mesh, part ? part->whole(last) : last);
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

std::vector<ErrorEstimate> recovered_errors(const Scene& scene, const Mesh& mesh, const StepRecord& state, const std::vector<Valued>& found) {
  const RecoveredError error = recovered_error(body_of(scene, mesh), state.u);
  std::vector<ErrorEstimate> estimates;
  for (const Valued& q : found) {
    const double cells = q.name == "force" ? error.energy_share() * q.value : q.name == "von_mises_max" ? error.von_mises_spread : -1;
    if (cells >= 0) estimates.push_back({q, cells, 0, 0, state.residual * std::abs(q.value), false});
  }
  return estimates;
}

std::vector<ErrorEstimate> estimate_errors(const SolveConfig& config, const std::optional<Material>& material,
                                           const std::function<Place(const std::string&)>& where, const std::vector<Valued>& found,
                                           double residual) {
  if (!config.mesh || !has_edge_in_contact_radii(config.mesh->geometry))
    throw Failure(Exit::config, Error{where("estimate"), "estimate", "the mesh is not an indented_block or indented_disc of this config", "", ""});
  const auto on_cells = [&](double longer) {
    SolveConfig coarser = config;
    *edge_in_contact_radii(coarser.mesh->geometry) *= longer;
    return coarser;
  };
  SolveConfig coarser = on_cells(ratio);
  const std::vector<Valued> coarse = end_of_path(coarser, material, where);
  const std::vector<Valued> coarsest = end_of_path(on_cells(ratio * ratio), material, where);
  std::vector<Valued> path = coarse;
  double per_change = 0;
  if (has_friction(config)) {
    const double increment = config.path.steps ? 1.0 / *config.path.steps : config.path.largest;
    per_change = increment > 0.5 ? -1 : 1.0 / 3;
    set_increment(coarser.path, increment > 0.5 ? 0.5 * increment : 2 * increment);
    path = end_of_path(coarser, material, where);
  }
  std::vector<ErrorEstimate> estimates;
  for (const Valued& q : found) {
    const auto in = [&](const std::vector<Valued>& other) {
      return std::find_if(other.begin(), other.end(), [&](const Valued& v) { return v.name == q.name; });
    };
    const auto at = in(coarse), before = in(coarsest), along = in(path);
    if (at == coarse.end() || before == coarsest.end() || along == path.end()) continue;
    const Fitted fitted = fit({q.value, at->value, before->value}, q.name == "von_mises_max" ? 1 : 2);
    estimates.push_back({q, fitted.cells, per_change * (along->value - at->value), fitted.scatter, residual * std::abs(q.value)});
  }
  return estimates;
}

}  // namespace langer
