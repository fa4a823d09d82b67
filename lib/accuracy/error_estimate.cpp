#include "accuracy/error_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <set>

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
constexpr Lengths of_block{0.18, 0.125}, with_friction{0.14, 0.125};
constexpr Lengths of_disc{0.07, 0.0442};  // a line of nodes in contact: nothing averages
constexpr std::array longer{1.25, 1.5}, hex27_longer{std::numbers::sqrt2, 2.0};
constexpr double few = 0.125;                // increments that are longer do not follow their law
constexpr double apart = 1.08, longest = 3;  // lengths of two meshes' cells, at least; the coarsest, at most
using Find = std::function<Place(const std::string&)>;

// the mean of those axes that have more than one
double cells_along(const Geometry& geometry) {
  double sum = 0;
  int axes = 0;
  for (int n : numbers_of_cells(geometry))
    if (n > 1) sum += std::log(n), ++axes;
  return std::exp(sum / std::max(axes, 1));
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
  std::vector<double> hex27_length;      // of the hex27 meshes' cells, the solved one included
  bool own = false;                      // the solved mesh is the finest of its family
  SolveConfig other_increments;
  double per_change = 0;  // error of the increments per what these change; 0: none, the path does not matter
  int n_scenes() const { return static_cast<int>(hex8.size() + hex27.size()) + (per_change != 0); }
};

Failure too_few_cells(const std::string& which, const Find& where) {
  return Failure(Exit::not_converged, Error{where("estimate"), "estimate",
                                            "too few cells" + which + " to make coarser meshes from them", "shorter cells", ""});
}

// numbers that a factor below two divides without a change of the cells' shape
void need_some_cells(const Geometry& geometry, const Find& where) {
  if (has_edge_in_contact_radii(geometry)) return;
  const std::vector<int> n = numbers_of_cells(geometry);
  for (std::size_t i = 0; i < n.size(); ++i)
    if (n[i] == 2 || n[i] == 3) throw too_few_cells(fmt::format(" along {} ({}; 1, or 4 and more)", "xyz"[i], n[i]), where);
}

// a mesh with an odd number of cells has less of it than one that names it
void any_symmetry(SolveConfig& config) {
  if (config.symmetry != SymmetryChoice::none) config.symmetry = SymmetryChoice::automatic;
}

// coarser ones with `other`'s cells, all longer by one factor
void add_longer_hex8(Refinements& refined, SolveConfig other, const Find& where) {
  Geometry& geometry = other.mesh->geometry;
  refined.length = {1};
  const double cells = cells_along(geometry);
  for (double factor : longer) {
    do lengthen_cells(geometry, factor);  // a few layers may be divided by two factors alike
    while (cells / cells_along(geometry) < apart * refined.length.back() && (factor *= 1.1) < longest);
    if (factor >= longest) throw too_few_cells("", where);
    refined.length.push_back(cells / cells_along(geometry));
    refined.hex8.push_back(other);
  }
}

void add_longer_hex27(Refinements& refined, const SolveConfig& config) {
  const double cells = cells_along(config.mesh->geometry);
  refined.hex27_length = {1};
  for (double factor : hex27_longer) {
    SolveConfig other = config;
    Geometry& geometry = other.mesh->geometry;
    const bool by_edge = has_edge_in_contact_radii(geometry);
    by_edge ? scale_cells(geometry, factor) : lengthen_cells(geometry, factor);
    if (!by_edge) any_symmetry(other);
    refined.hex27_length.push_back(by_edge ? factor : cells / cells_along(geometry));
    refined.hex27.push_back(other);
  }
}

Refinements refinements(const SolveConfig& config, const Find& where) {
  if (!config.mesh || !has_numbers_of_cells(config.mesh->geometry))
    throw Failure(Exit::config, Error{where("estimate"), "estimate", "a mesh whose cells follow from no numbers of this config",
                                      "geometry: {block: ...}, section, indented_block or indented_disc", ""});
  need_some_cells(config.mesh->geometry, where);
  Refinements refined;
  SolveConfig other = config;
  Geometry& geometry = other.mesh->geometry;
  const bool quadratic = reference(config.mesh->cells).second_order();
  const bool locks = config.formulation == Formulation::displacement;  // and with it its limit on such cells
  refined.own = !quadratic && !locks;
  if (const double* edge = edge_in_contact_radii(geometry)) {
    const Lengths lengths = is_section(geometry) ? of_disc : has_friction(config) ? with_friction : of_block;
    refined.own = refined.own && *edge <= lengths.fine_enough;
    if (!refined.own) *edge_in_contact_radii(geometry) = std::min(quadratic ? 0.5 * *edge : *edge, lengths.finest);
  } else {
    if (quadratic) scale_cells(geometry, 0.5);  // as many nodes
    any_symmetry(other);
  }
  if (!refined.own) {
    other.mesh->cells = CellType::hex8;
    other.formulation.reset();
  }
  if (!quadratic || !config.contacts.empty()) {
    if (!refined.own) refined.hex8.push_back(other);
    add_longer_hex8(refined, other, where);
  }
  if (quadratic) add_longer_hex27(refined, config);
  if (!has_friction(config)) return refined;
  const double increment = config.path.largest_increment();
  const bool shorter = increment >= 0.1;
  const double another = shorter ? std::min(0.5 * increment, few) : 2 * increment, ratio = increment / another;
  refined.per_change = shorter ? -ratio * ratio / (ratio * ratio - 1) : 1;
  refined.other_increments = refined.hex8.back();
  refined.other_increments.path.use_increment(another);
  return refined;
}

// Whether a face of the body is held or moved in its plane, too: at its edges stresses are singular.
bool is_clamped(const SolveConfig& config) {
  std::map<std::string, std::set<Axis>> given;
  for (const SupportConfig& support : config.supports) given[support.on].insert(support.hold.begin(), support.hold.end());
  for (const LoadConfig& load : config.loads) {
    const Displacement& u = load.displacement;
    for (const auto& [component, axis] : {std::pair{&u.x, Axis::x}, {&u.y, Axis::y}, {&u.z, Axis::z}})
      if (*component) given[load.on].insert(axis);
  }
  return std::any_of(given.begin(), given.end(), [](const auto& on) { return on.second.size() > 1; });
}

// A rigid face presses an edge into the body, its own or the body's: there stresses are singular, and errors fall with h alone. So they
// do where a force is passed on by a clamped face; below an indenter such a face is far away.
double order_of_force(const SolveConfig& config) {
  if (config.contacts.empty()) return is_clamped(config) ? 1 : 2;
  return std::any_of(config.contacts.begin(), config.contacts.end(),
                     [](const auto& contact) {
                       return std::holds_alternative<Plane>(contact.second.rigid) ||
                              std::holds_alternative<Cylinder>(contact.second.rigid);
                     })
             ? 1
             : 2;
}

std::set<std::string> moved_sets(const SolveConfig& config) {
  std::set<std::string> moved;
  for (const LoadConfig& load : config.loads)
    if (const Displacement& u = load.displacement; u.x.value_or(0) != 0 || u.y.value_or(0) != 0 || u.z.value_or(0) != 0)
      moved.insert(load.on);
  return moved;
}

Vec3 force_of(const StepRecord& state, const std::string& contact) {
  Vec3 force;
  for (int j = 0; j < 3; ++j) force[j] = state.scalars.at("force_" + contact + "_" + "xyz"[j]);
  return force;
}

const Valued& quantity(const Valued& found) { return found; }
const Valued& quantity(const ErrorEstimate& estimate) { return estimate.of; }

template <class Item>
std::vector<Item> forces_among(const std::vector<Item>& all) {
  for (const char* begins : {"force_", "force", "reaction_"}) {
    std::vector<Item> found;
    std::copy_if(all.begin(), all.end(), std::back_inserter(found),
                 [&](const Item& item) { return quantity(item).name.starts_with(begins); });
    if (!found.empty()) return found;
  }
  return {};
}

}  // namespace

std::vector<Valued> forces_judged(const std::vector<Valued>& found) { return forces_among(found); }
std::vector<ErrorEstimate> forces_judged(const std::vector<ErrorEstimate>& estimates) { return forces_among(estimates); }

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
  return valued(config, run.scene, run.mesh, end.last);
}

std::vector<Valued> valued(const SolveConfig& config, const Scene& scene, const Mesh& mesh, const StepRecord& state) {
  std::vector<Valued> found;
  if (!scene.contacts.empty()) found.push_back({"force", "N", state.force_ind.norm()});
  if (scene.contacts.size() > 1)
    for (const RigidContact& contact : scene.contacts)
      found.push_back({"force_" + contact.name, "N", force_of(state, contact.name).norm()});
  for (const std::string& set : moved_sets(config)) {
    Vec3 reaction = Vec3::Zero();
    for (int n : mesh.node_sets.at(set)) reaction += state.reaction[static_cast<std::size_t>(n)];
    found.push_back({"reaction_" + set, "N", reaction.norm()});
  }
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
  const Family alike = refined.hex27.empty() ? family : solved(refined.hex27, {refined.hex27_length, itself});
  const Family path = refined.per_change == 0 ? Family{} : solved({refined.other_increments}, {{}, {family.found.back()}});

  std::vector<ErrorEstimate> estimates;
  for (const Valued& q : found) {
    const bool force = q.of_force();
    const double order = force ? order_of_force(config) : q.name == "von_mises_max" ? 1 : 2;
    const auto limit = limit_of(force && !family.found.empty() ? family : alike, q.name, order);
    if (!limit) continue;
    double increments = 0;
    if (!path.found.empty()) increments = refined.per_change * (path.of(1, q.name).value_or(0) - path.of(0, q.name).value_or(0));
    estimates.push_back({q, q.value - limit->value, increments, limit->scatter, residual * std::abs(q.value), order});
  }
  return estimates;
}

std::vector<ErrorEstimate> estimated(const SolveConfig& config, const std::optional<Material>& material, const Find& where,
                                     const Run& run, const StepRecord& last, const EstimateListener& listener) {
  const std::vector<Valued> found = valued(config, run.scene, run.mesh, last);
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
