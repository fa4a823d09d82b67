#include "accuracy/estimate/error_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <span>

#include "accuracy/estimate/dual_estimate.hpp"
#include "accuracy/estimate/least_scatter.hpp"
#include "accuracy/estimate/observed_law.hpp"
#include "accuracy/estimate/pad_edges.hpp"
#include "accuracy/estimate/refinements.hpp"
#include "accuracy/estimate/truncation.hpp"
#include "core/base/interrupt.hpp"
#include "core/base/stopwatch.hpp"
#include "core/base/text.hpp"
#include "core/tensor/stress.hpp"
#include "mechanics/assembly/assembler.hpp"
#include "mechanics/mesh/reference.hpp"
#include "results/post/nodal_fields.hpp"
#include "scene/run/body_mesh.hpp"
#include "scene/run/dry_run.hpp"
#include "scene/run/holes.hpp"
#include "scene/run/loaded_area.hpp"

namespace langer {

namespace {

using Find = std::function<Place(const std::string&)>;

// one scene on meshes whose cells differ by one factor everywhere
struct Family {
  std::vector<double> length = {};  // of cells, in those of the first
  std::vector<SolvedPath> of = {};

  // of a quantity at the end, on every mesh; nothing where one lacks it
  std::vector<double> ends(const std::string& name) const {
    std::vector<double> values;
    for (const SolvedPath& mesh : of)
      for (const Valued& v : mesh.found)
        if (v.name == name) values.push_back(v.value);
    if (values.size() == of.size()) return values;
    return std::vector<double>{};
  }
  std::vector<double> forces(const std::string& name, double t) const {
    std::vector<double> values;
    for (const SolvedPath& mesh : of) values.push_back(force_at(mesh.path, name, t));
    return values;
  }
  // the power of 1 / length with which the CPU time grows; 0 where it is too short to tell
  double growth() const {
    constexpr double shortest = 0.05;                          // [s]
    const std::size_t first = of.front().seconds > 0 ? 0 : 1;  // of the run itself no time is known
    if (of.size() < first + 2 || of.back().seconds < shortest || of[first].seconds < shortest)
      return 0;
    return std::clamp(
        std::log(of[first].seconds / of.back().seconds) / std::log(length.back() / length[first]),
        1.0, 9.0);
  }
};

// whether the meshes of the config are those of a family (meshing/box.hpp)
bool in_family(SolveConfig config) {
  return config.mesh && family_of(config.mesh->geometry) != nullptr;
}

struct Limit {
  double value;
  double scatter;  // root mean square of what the fit leaves
};
// f of q = f + A length^order, weights falling with the square of the length
std::optional<Limit> limit_of(const std::vector<double>& length, const std::vector<double>& values,
                              double order) {
  if (values.empty()) return std::nullopt;
  const auto n = static_cast<Eigen::Index>(length.size());
  VecX w(n), x(n), q(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto mesh = static_cast<std::size_t>(i);
    w[i] = std::pow(length[mesh], -2);
    x[i] = std::pow(length[mesh], order);
    q[i] = values[mesh];
  }
  w /= w.sum();
  const double x_mean = w.dot(x);
  const double q_mean = w.dot(q);
  const VecX dx = x.array() - x_mean;
  const VecX dq = q.array() - q_mean;
  const double A = w.dot(dx.cwiseProduct(dq)) / w.dot(dx.cwiseProduct(dx));
  const VecX left = dq - A * dx;
  return Limit{q_mean - A * x_mean, std::sqrt(w.dot(left.cwiseProduct(left)))};
}

// Faces of the body that are held or moved in their plane, too: at their edges stresses are
// singular.
std::vector<std::string> clamped_sets(const SolveConfig& config) {
  std::map<std::string, std::set<Axis>> given;
  for (const SupportConfig& support : config.supports)
    given[support.on].insert(support.hold.begin(), support.hold.end());
  for (const LoadConfig& load : config.loads) {
    for (int axis = 0; axis < 3; ++axis)
      if (load.tells(axis)) given[load.on].insert(static_cast<Axis>(axis));
  }
  std::vector<std::string> sets;
  for (const auto& [on, axes] : given)
    if (axes.size() > 1) sets.push_back(on);
  return sets;
}

bool is_clamped(const SolveConfig& config) { return !clamped_sets(config).empty(); }

// Whether a node belongs to a cell at a face with edges at which stresses are singular. Under an
// indenter edges are far away.
bool is_at_edge(const SolveConfig& config, const Mesh& mesh, int node) {
  std::vector<std::string> sets;
  if (config.contacts.empty()) sets = clamped_sets(config);
  // The edges of a clamped face that is moved carry the load: however low the stress is there on
  // long cells, on shorter ones it is the greatest.
  const std::set<std::string> moved = moved_sets(config);
  if (std::ranges::any_of(sets, [&](const std::string& set) { return moved.contains(set); }))
    return true;
  if (has_pads(config))
    for (const auto& [name, contact] : config.touching) {
      sets.push_back(contact.on);
      sets.push_back(contact.against.value_or(contact.on));
    }
  if (sets.empty()) return false;
  std::set<int> at_faces;
  for (const std::string& set : sets)
    if (const auto nodes = mesh.node_sets.find(set); nodes != mesh.node_sets.end())
      at_faces.insert(nodes->second.begin(), nodes->second.end());
  const auto of_cell = static_cast<std::size_t>(nodes_per_cell(mesh.type));
  for (std::size_t first = 0; first < mesh.connectivity.size(); first += of_cell) {
    const std::span cell(mesh.connectivity.begin() + static_cast<std::ptrdiff_t>(first), of_cell);
    if (std::ranges::count(cell, node) > 0 &&
        std::ranges::any_of(cell, [&](int n) { return at_faces.contains(n); }))
      return true;
  }
  return false;
}

const Valued& quantity(const Valued& found) { return found; }
const Valued& quantity(const ErrorEstimate& estimate) { return estimate.of; }

template <class Item>
std::vector<Item> forces_among(const std::vector<Item>& all) {
  std::vector<Item> found;
  const auto take = [&](const char* begins) {
    std::copy_if(all.begin(), all.end(), std::back_inserter(found),
                 [&](const Item& item) { return quantity(item).name.starts_with(begins); });
  };
  if constexpr (std::is_same_v<Item, ErrorEstimate>) {
    std::ranges::copy_if(all, std::back_inserter(found), &ErrorEstimate::asked);
    if (!found.empty()) return found;
  }
  for (const char* begins : {"travel_", "force_", "force", "reaction_"})
    if (found.empty()) take(begins);
  take("torque_");
  std::copy_if(all.begin(), all.end(), std::back_inserter(found), [](const Item& item) {
    return quantity(item).name == "pull_off" && quantity(item).value > 0;
  });
  if (found.empty()) take("displacement_");
  return found;
}

}  // namespace

bool Valued::of_contact() const { return of_force() || of_travel(); }

// A rigid face presses an edge into the body, its own or the body's: there stresses are singular,
// and errors fall with h alone. So they do where a force is passed on by a clamped face; below an
// indenter such a face is far away.
double order_of_force(const SolveConfig& config) {
  if (config.contacts.empty() && config.touching.empty() && is_clamped(config)) return 1;
  int order = 2;
  for (const auto& [name, contact] : config.contacts)
    order = std::min(order, force_order(contact.rigid.value()));
  return order;
}

bool needs_the_mesh(const SolveConfig& config) {
  if (!config.accuracy) return false;
  return config.accuracy->answer == AccuracyOf::mesh ||
         config.accuracy->at == AccuracyAt::every_step;
}

std::vector<Valued> forces_judged(const std::vector<Valued>& found) { return forces_among(found); }
std::vector<ErrorEstimate> forces_judged(const std::vector<ErrorEstimate>& estimates) {
  return forces_among(estimates);
}

namespace {

// What the whole path decides, as the greatest pull, is not known from its last state.
std::vector<Valued> on_path(std::vector<Valued> found, const std::vector<StepForces>& path) {
  for (Valued& q : found)
    if (q.name == "pull_off" && !path.empty()) q.value = path.back().of.at(q.name);
  return found;
}

}  // namespace

void need_the_end_of_other(const RunEnd& end) {
  if (end.at == RunEnd::At::signal)
    throw Failure(exit_code_of(interrupted()),
                  Error{{}, "", fmt::format("stopped by {}", signal_name(interrupted())), "", ""});
  if (!end.path.complete)
    throw Failure(
        Exit::not_converged,
        Error{{},
              "",
              fmt::format("the solve with the refined mesh found no equilibrium at t = {:.6g}: {}",
                          end.path.t, end.path.why),
              "",
              ""});
}

SolvedPath solved_path(const SolveConfig& config, const std::optional<Material>& material,
                       const Find& where, const std::function<RunListener(const Run&)>& listener) {
  SolvedPath solved;
  const double begun = cpu_seconds();
  Run run(body_mesh(config, "", where), config, material, where);
  RunListener progress;
  if (listener) progress = listener(run);
  const RunEnd end = run.follow(collecting(std::move(progress), config, run, solved.path));
  need_the_end_of_other(end);
  solved.found = on_path(valued(config, run.scene, run.mesh, end.last), solved.path);
  solved.seconds = cpu_seconds() - begun;
  return solved;
}

std::vector<Valued> end_of_path(const SolveConfig& config, const std::optional<Material>& material,
                                const Find& where,
                                const std::function<RunListener(const Run&)>& listener) {
  return solved_path(config, material, where, listener).found;
}

std::vector<Valued> valued_forces(const StepForces& forces) {
  std::vector<Valued> found;
  for (const auto& [name, size] : forces.of) {
    const char* unit = unit::N;
    if (name.starts_with("torque_")) unit = "N mm";
    if (name.starts_with("travel_") || name.starts_with("displacement_") || name == "apex_height")
      unit = unit::mm;
    if (name == "von_mises_max") unit = unit::MPa;
    found.push_back({name, unit, size});
  }
  return found;
}

std::vector<Valued> valued(const SolveConfig& config, const Scene& scene, const Mesh& mesh,
                           const StepRecord& state) {
  std::vector<Valued> found = valued_forces(step_forces(config, scene, mesh, state));
  const auto known = [&](const std::string& name) {
    return std::ranges::any_of(found, [&](const Valued& q) { return q.name == name; });
  };
  // the stress of a viscous body follows from all of its steps, and one is here
  if (!has_viscous_law(scene)) {
    const std::string name = "von_mises_max";
    const LargestStress most = largest_von_mises_at(scene, mesh, state.u);
    if (!known(name)) found.push_back({name, "MPa", most.value});
    for (Valued& q : found)
      if (q.name == name) q.at_edge = is_at_edge(config, mesh, most.node);
  }
  for (const auto& [name, nodes] : mesh.node_sets)
    if (nodes.size() == 1 && !known("displacement_" + name))
      found.push_back(
          {"displacement_" + name, "mm", state.u[static_cast<std::size_t>(nodes[0])].norm()});
  return found;
}

bool is_given(const SolveConfig& config, const std::string& name) {
  return std::ranges::any_of(config.contacts, [&](const auto& one) {
    const auto& [contact, of] = one;
    return of.control &&
           (name == "force_" + contact || (name == "force" && config.contacts.size() == 1));
  });
}

namespace {

// What an estimate by refinement has solved.
struct Solutions {
  Family family, same_cells;  // hex8; the cells of the run, where these are others
  std::vector<SolvedPath>
      other;  // in other increments on the longest cells of the family, where the path matters
  std::map<Truncation, std::vector<SolvedPath>> wide;

  // meshes of the kind that tells: stresses and what lies far from the contact are those of the
  // cells
  const Family& any() const {
    if (family.of.empty()) return same_cells;
    return family;
  }
  const Family& meshes_for(const Valued& q) const {
    if ((q.of_force() && !family.of.empty()) || same_cells.of.empty()) return family;
    return same_cells;
  }
  // what the body leaves out of a quantity at t, on the longest cells
  std::vector<ErrorEstimate::Part> left_out(const Valued& q, double t) const {
    std::vector<ErrorEstimate::Part> parts;
    for (const auto& [truncation, two] : wide) {
      const auto on = [&](const SolvedPath& path) {
        return force_at(path.path, q.name, t);
      };
      const double f = on(any().of.back());
      if (f != 0)
        parts.push_back({names(truncation)[static_cast<int>(truncation)],
                         q.value / f * beyond(f, on(two[0]), on(two[1]))});
    }
    return parts;
  }
};

Solutions solve_all(const Refinements& refined, const SolvedPath& itself,
                    const std::function<SolvedPath(const SolveConfig&)>& solved) {
  Solutions all;
  all.family.length = refined.length;
  if (refined.own) all.family.of.push_back(itself);
  for (const SolveConfig& scene : refined.hex8) all.family.of.push_back(solved(scene));
  if (!refined.hex27.empty()) all.same_cells = {refined.hex27_length, {itself}};
  for (const SolveConfig& scene : refined.hex27) all.same_cells.of.push_back(solved(scene));
  if (refined.per_change != 0) all.other.push_back(solved(refined.other_increments));
  for (const auto& [truncation, scenes] : refined.wider)
    for (const SolveConfig& scene : scenes) all.wide[truncation].push_back(solved(scene));
  return all;
}

}  // namespace

namespace {

// Nodes come into contact one by one, and errors go to and fro meanwhile: before the end no bar is
// shorter, relative to its force, than those of the steps beside it.
std::vector<double> no_shorter_than_beside(const std::vector<double>& bars,
                                           const std::vector<StepForces>& path,
                                           const std::string& force) {
  std::vector<double> out = bars;
  for (std::size_t i = 0; i + 1 < bars.size(); ++i)
    for (std::size_t j : {i == 0 ? i : i - 1, i + 1})
      if (const double q = path[j].of.at(force); q > 0)
        out[i] = std::max(out[i], bars[j] / q * path[i].of.at(force));
  return out;
}

}  // namespace

double judged_at(const SolveConfig& config, const std::vector<StepForces>& path,
                 const std::string& name) {
  const std::optional<AccuracyAt> at = config.accuracy ? config.accuracy->at : std::nullopt;
  if (path.empty() || (at && *at != AccuracyAt::maximum)) return 1;
  double largest = 0;
  double where = 1;
  for (const StepForces& step : path) {
    const auto found = step.of.find(name);
    if (found == step.of.end() || std::abs(found->second) <= largest) continue;
    largest = std::abs(found->second);
    where = step.t;
  }
  const bool ends_low = std::abs(force_at(path, name, 1)) < 0.5 * largest;
  if (at || ends_low) return where;
  return 1;
}

ErrorEstimate worst_of(const std::vector<ErrorEstimate>& steps) {
  ErrorEstimate worst = steps.front();
  double largest = 0;
  for (const ErrorEstimate& e : steps) {
    largest = std::max(largest, std::abs(e.of.value));
    if (e.total() > worst.total()) worst = e;
  }
  worst.largest = largest;
  return worst;
}

namespace {

bool is_asked(const SolveConfig& config, const std::string& name) {
  if (!config.accuracy) return false;
  const std::optional<std::string> asked = config.accuracy->quantity();
  return asked && (name == *asked || name.starts_with(*asked + "_"));
}

}  // namespace

void mark_asked(const SolveConfig& config, const Find& where, const std::vector<Valued>& found,
                std::vector<ErrorEstimate>& estimates) {
  if (!config.accuracy || !config.accuracy->of) return;
  bool any = false;
  for (ErrorEstimate& e : estimates) {
    e.asked = is_asked(config, e.of.name);
    any = any || e.asked;
  }
  if (any) return;
  std::string known;
  std::string hint;
  for (const ErrorEstimate& e : estimates) append(known, ", ", e.of.name);
  for (const Valued& q : found)
    if (is_asked(config, q.name)) hint = over_an_edge(config, q.name);
  if (hint.empty() && config.accuracy->of == "pull_off") hint = "contacts.<name>.adhesion pulls";
  throw Failure(
      Exit::config,
      Error{where("accuracy.of"), "accuracy.of", "found \"" + *config.accuracy->of + "\"",
            known.empty() ? "a quantity of this scene; it has none" : "one of " + known, hint});
}

namespace {

// How far the indenters move, at most [mm].
double travel_of_indenters(const SolveConfig& config, const SolvedPath& solved) {
  double furthest = 0;
  for (const auto& [name, contact] : config.contacts)
    for (const WaypointConfig& waypoint : contact.motion)
      furthest = std::max(furthest, Vec3(waypoint.to[0], waypoint.to[1], waypoint.to[2]).norm());
  for (const StepForces& step : solved.path)
    for (const auto& [name, value] : step.of)
      if (name.starts_with("travel_")) furthest = std::max(furthest, std::abs(value));
  return furthest;
}

// A load on a part of a side acts on whole facets. Coarser meshes whose lines do not meet its edges
// solve another scene. With an accuracy, lines are put there.
std::string other_areas(const SolveConfig& config, const Refinements& refined, const Find& where) {
  constexpr double alike = 0.05;
  if (!config.mesh || in_family(config)) return "";
  const auto is_on_a_part = [&](const LoadConfig& load) {
    return load.on_surface() && config.mesh->sets.contains(load.on);
  };
  if (std::ranges::none_of(config.loads, is_on_a_part)) return "";
  const Mesh own = body_mesh(config, "", where);
  for (const std::vector<SolveConfig>& scenes : {refined.hex8, refined.hex27})
    for (const SolveConfig& scene : scenes) {
      const Mesh mesh = body_mesh(scene, "", where);
      for (const LoadConfig& load : config.loads) {
        if (!is_on_a_part(load)) continue;
        const double area = area_of(own, load.on);
        const double there = area_of(mesh, load.on);
        if (area == 0 || std::abs(there / area - 1) < alike) continue;
        return fmt::format(
            "the errors are not known: the set \"{}\" of a load has {:.4g} mm^2, and {:.4g} mm^2 on coarser cells; "
            "accuracy puts lines of the grid along the edges of boxes",
            load.on, area, there);
      }
    }
  return "";
}

}  // namespace

namespace {

// The greatest force of an indenter that is drawn off is its pull-off. Bonds let go at another t on
// each mesh, so values at one t may agree by chance: its bar is not shorter than that of the pull.
void as_long_as_that_of_pull(std::vector<ErrorEstimate>& estimates) {
  const auto pull = std::ranges::find_if(
      estimates, [](const ErrorEstimate& e) { return e.of.name == "pull_off"; });
  if (pull == estimates.end()) return;
  constexpr double alike = 0.05;
  for (ErrorEstimate& e : estimates) {
    const bool is_pull = e.of.name.starts_with("force") &&
                         std::abs(std::abs(e.of.value) - pull->of.value) <= alike * pull->of.value;
    if (is_pull) e.scatter += 0.5 * std::max(0.0, pull->total() - e.total());
  }
}

}  // namespace

PathErrors estimate_along(const SolveConfig& config, const std::optional<Material>& material,
                          const Find& where, const SolvedPath& itself, double residual,
                          const EstimateListener& listener) {
  const Refinements refined = refinements(config, where);
  if (std::string why = other_areas(config, refined, where); !why.empty()) {
    PathErrors nothing;
    nothing.not_known.push_back(std::move(why));
    return nothing;
  }
  int begun = 0;
  const Solutions all = solve_all(refined, itself, [&](const SolveConfig& scene) {
    ++begun;
    const auto shown = [&](const Run& run) {
      if (listener) return listener(run, begun, refined.n_scenes());
      return RunListener{};
    };
    try {
      return solved_path(scene, material, where, shown);
    } catch (const Failure& failure) {
      if (failure.code() != Exit::config) throw;
      // as a round set that has no whole facet there
      throw Failure(Exit::not_converged,
                    Error{{}, "", fmt::format("on coarser cells, {}", failure.what()), "", ""});
    }
  });
  PathErrors out;
  // no study stands for these scenes: their meshes show the order themselves
  const bool observes = config.contacts.empty() || !config.touching.empty() || in_family(config);
  // At the edge of a pad with friction the shear is singular: three meshes may seem to converge
  // faster than the next ones do. What they differ by counts as scatter, too.
  const bool rubs = std::ranges::any_of(
      config.touching, [](const auto& contact) { return contact.second.friction > 0; });
  const bool has_edges = rubs || has_pads(config);
  const double of_pads = beside_pads(config);
  const double across_layers = across_few_cells(config);
  const double travel = travel_of_indenters(config, itself);
  const bool section = config.mesh && is_section(config.mesh->geometry);
  const double on_layer = on_thin_layer(config);
  const double beside_hole = beside_holes(config);
  const bool clamped = is_clamped(config);
  const double beside_rim = std::max(beside_rims(config, clamped), under_holes(config));
  const double beside_end = beside_ends_of_supports(config);
  const bool at_held_edges = config.contacts.empty() && (clamped || beside_end > 0);
  double beside_clamp = 0;
  if (config.contacts.empty() && config.touching.empty() && clamped)
    beside_clamp = beside_clamps(config);
  const auto judged = [&](const Valued& q, double t, const std::vector<double>& on_meshes,
                          const std::vector<double>& in_increments) {
    double order = 1;
    if (q.name != "von_mises_max" && !has_edges) order = order_of_force(config);
    const auto limit = limit_of(all.meshes_for(q).length, on_meshes, order);
    if (!limit) return std::optional<ErrorEstimate>();
    std::optional<ObservedLaw> law;
    if (observes) law = observed_law(all.meshes_for(q).length, on_meshes, order);
    double increments = 0;
    if (in_increments.size() == 2) {
      increments = refined.per_change * (in_increments[1] - in_increments[0]);
    }
    ErrorEstimate e{
        q, q.value - limit->value, increments, limit->scatter, residual * std::abs(q.value), order};
    e.t = t;
    e.limit_has_bar =
        !observes && !section && q.of_contact() && q.name != "pull_off" && !needs_the_mesh(config);
    if (law) {
      e.cells = q.value - law->limit;
      e.scatter = law->scatter;
      e.order = law->order;
      e.order_observed = law->order < order && !law->grows;
      // at the edges of what is held it is singular, and values that go to and fro show no limit
      const bool to_and_fro = at_held_edges && law->scatter > 1e-3 * std::abs(q.value);
      e.grows = q.name == "von_mises_max" && (law->grows || to_and_fro);
    }
    if (rubs && law) {
      e.order_observed = true;
      e.scatter = std::max(e.scatter, 0.5 * std::abs(on_meshes.front() - on_meshes.back()));
    }
    constexpr double uniform = 1e-6;  // of bodies that deform alike everywhere
    if (q.at_edge && std::abs(e.cells) + e.scatter > uniform * std::abs(q.value)) e.grows = true;
    const double touching =
        touching_at(all.meshes_for(q).of.front().path, q.of_force() ? q.name : "force", t);
    if (q.name == "von_mises_max") {
      const double least = std::max(between_points(config, touching, section), across_layers);
      e.scatter = std::max(e.scatter, 0.5 * least * std::abs(q.value));
    }
    if (q.unit == unit::mm && !q.of_travel())
      e.scatter = std::max({e.scatter, 0.5 * beside_contact(config, touching, section) * travel,
                            0.5 * beside_rim * std::abs(q.value)});
    if (q.unit != unit::MPa)
      e.scatter = std::max(e.scatter, 0.5 * std::max(beside_end, of_pads) * std::abs(q.value));
    if (law && law->scatter > 0 && q.of_force())
      e.scatter = std::max(e.scatter, 0.5 * beside_clamp * std::abs(q.value));
    if (q.of_contact()) {
      double single = on_layer * one_by_one(touching, section);
      if (q.name == "pull_off") single = bond_by_bond(touching, section);
      e.by_single_nodes = 0.5 * single * std::abs(q.value);
      e.scatter = std::max({e.scatter, e.by_single_nodes,
                            0.5 * round_an_edge(config, touching, section) * std::abs(q.value),
                            0.5 * shear_on_section(config, touching, section) * std::abs(q.value),
                            0.5 * beside_hole * std::abs(q.value)});
      if (refined.edge_unresolved)  // without a sign: three such meshes tell none of it
        e.scatter += 0.5 * std::max(0.0, shear_at_edge(config, touching) * std::abs(q.value) -
                                             std::abs(e.cells));
    }
    return std::optional(e);
  };
  Family increments;
  const std::vector<SolvedPath>& meshes = all.any().of;
  if (!all.other.empty())
    increments.of = {refined.edge_unresolved ? meshes[1] : meshes.back(), all.other[0]};
  for (const Valued& q : itself.found) {
    if (is_given(config, q.name)) continue;
    if (std::string why = over_an_edge(config, q.name); !why.empty()) {
      out.not_known.push_back(std::move(why));
      continue;
    }
    const Family& meshes_of_q = all.meshes_for(q);
    const bool has_path = !itself.path.empty() && itself.path.back().of.contains(q.name);
    double t = 1;
    if (has_path) t = judged_at(config, itself.path, q.name);
    constexpr double no_stress = 1e-10;  // [MPa], as after an unloading
    if (q.name == "von_mises_max" && q.value < no_stress && !has_path) continue;
    std::optional<ErrorEstimate> estimate;
    if (t == 1) {
      estimate = judged(q, 1, meshes_of_q.ends(q.name), increments.ends(q.name));
    } else {
      Valued there = q;
      there.value = force_at(itself.path, q.name, t);
      estimate = judged(there, t, meshes_of_q.forces(q.name, t), increments.forces(q.name, t));
    }
    if (!estimate) continue;
    if (has_path) {
      std::vector<ErrorEstimate> steps;
      for (const StepForces& step : itself.path) {
        Valued there = q;
        there.value = force_at(itself.path, q.name, step.t);
        steps.push_back(*judged(there, step.t, meshes_of_q.forces(q.name, step.t),
                                increments.forces(q.name, step.t)));
      }
      if (config.accuracy && config.accuracy->at == AccuracyAt::every_step)
        estimate = worst_of(steps);
      for (const ErrorEstimate& e : steps) out.along[q.name].push_back(e.total());
      out.along[q.name] = no_shorter_than_beside(out.along[q.name], itself.path, q.name);
      if (estimate->limit_has_bar) {
        PathErrors::Limits& limits = out.limits[q.name];
        for (const ErrorEstimate& e : steps) {
          limits.shares.push_back(e.limit_share());
          limits.bars.push_back(e.limit_bar());
        }
        limits.bars = no_shorter_than_beside(limits.bars, itself.path, q.name);
      }
    }
    if (q.name == "pull_off") estimate->increments -= pull_between_steps(itself.path);
    if (q.of_contact()) estimate->left_out = all.left_out(estimate->of, estimate->t);
    out.at_end.push_back(*estimate);
  }
  as_long_as_that_of_pull(out.at_end);
  mark_asked(config, where, itself.found, out.at_end);
  const bool same_cells_are_solved = !all.same_cells.of.empty();
  out.growth = same_cells_are_solved ? all.same_cells.growth() : all.family.growth();
  return out;
}

std::vector<ErrorEstimate> estimate_errors(const SolveConfig& config,
                                           const std::optional<Material>& material,
                                           const Find& where, const std::vector<Valued>& found,
                                           double residual, const EstimateListener& listener) {
  return estimate_along(config, material, where, {found, {}, 0}, residual, listener).at_end;
}

PathErrors estimated(const SolveConfig& config, const std::optional<Material>& material,
                     const Find& where, Run& run, const StepRecord& last,
                     const std::vector<StepForces>& path, const EstimateListener& listener) {
  const std::vector<Valued> found = on_path(valued(config, run.scene, run.mesh, last), path);
  if (config.estimate == EstimateBy::dual) return dual_errors(config, run, last, found);
  return estimate_along(config, material, where, {found, path, 0}, relative_residual(last),
                        listener);
}

std::string in_words(const ErrorEstimate& e) {
  if (e.grows)
    return fmt::format("{} {:.4g} {} on these cells: it grows without bound on finer meshes",
                       e.of.name, e.of.value, e.of.unit);
  std::string at;
  if (e.t < 1) at = fmt::format(" at t = {:.4g}", e.t);
  std::string relative;
  if (e.largest) relative = fmt::format(" of the largest, {:.4g} {}", *e.largest, e.of.unit);
  if (e.none_yet())
    return fmt::format("{} 0 {}: {}", e.of.name, e.of.unit,
                       e.of.name.starts_with("force") ? "nothing is touched" : "no error");
  if (e.of.value == 0 && !e.largest)
    return fmt::format("{} 0 {} +- {:.2g} {}", e.of.name, e.of.unit, e.total(), e.of.unit);
  std::string in_unit;
  if (e.of.unit != unit::none) in_unit = " " + e.of.unit;
  const std::string begins = fmt::format("{}{} {:.4g}{} +- {:.2g} %{}", e.of.name, at, e.of.value,
                                         in_unit, e.in_percent(e.total()), relative);
  const double cells = e.in_percent(e.cells);
  const double solver = e.in_percent(e.solver);
  if (!e.has_limit) {
    const double increments = e.in_percent(e.increments);
    const double scatter = e.in_percent(e.scatter);
    std::string increments_text;
    std::string scatter_text;
    if (increments > 0) increments_text = fmt::format(", increments {:.2g}", increments);
    if (scatter > 0) scatter_text = fmt::format(", scatter {:.2g}", scatter);
    return fmt::format("{} (cells {:.2g} by recovery{}{}, solver {:.1g} %)", begins, cells,
                       increments_text, scatter_text, solver);
  }
  std::string left_out;
  for (const ErrorEstimate::Part& part : e.left_out) {
    append(left_out, ", ", fmt::format("{} {:+.2g}", part.name, e.in_percent(part.value)));
  }
  if (!left_out.empty()) left_out = "; left out: " + left_out + " %";
  std::string parts =
      fmt::format("cells {:+.2g}, increments {:+.2g}", cells, e.in_percent(e.increments));
  if (e.cells_with_increments) parts = fmt::format("cells and increments {:+.2g}", cells);
  parts +=
      fmt::format(", scatter {:.2g}, solver {:.1g} %{}", e.in_percent(e.scatter), solver, left_out);
  if (e.limit_answers)
    return fmt::format(
        "{}{} {:.4g}{} +- {:.2g} %, the limit of the meshes; on this one {:.4g}{} +- {:.2g} % ({})",
        e.of.name, at, e.limit(), in_unit, e.limit_percent(), e.of.value, in_unit,
        e.in_percent(e.total()), parts);
  return fmt::format("{} ({}); limit {:.4g}", begins, parts, e.limit());
}

std::vector<Summary> summary_of(const std::vector<ErrorEstimate>& estimates) {
  std::vector<Summary> summary;
  for (const ErrorEstimate& e : estimates) {
    if (e.grows) continue;  // no bar and no limit
    const auto add = [&](const char* what, double value) {
      summary.push_back({e.of.name + what, value, e.of.unit});
    };
    add("_error", e.limit_answers ? e.limit_bar() : e.total());
    add("_error_cells", e.cells);
    if (e.has_limit) add("_limit", e.limit());
    const double answer = e.limit_answers ? e.limit() : e.of.value;
    if (e.t < 1) {
      add("_judged", answer);
      summary.push_back({e.of.name + "_judged_at", e.t, "-"});
    }
    if (e.limit_answers) add(e.t < 1 ? "_judged_of_mesh" : "_of_mesh", e.of.value);
    add("_error_increments", e.increments);
    add("_error_scatter", e.scatter);
    add("_error_solver", e.solver);
    for (const ErrorEstimate::Part& part : e.left_out)
      add(("_error_" + part.name).c_str(), part.value);
  }
  return summary;
}

std::vector<Summary> with_answers(std::vector<Summary> numbers, const PathErrors& errors) {
  for (const ErrorEstimate& e : errors.at_end) {
    if (!e.limit_answers) continue;
    double share = e.limit_share();
    if (e.t < 1) share = errors.limits.at(e.of.name).shares.back();
    const auto found = std::ranges::find(numbers, e.of.name, &Summary::name);
    if (found != numbers.end()) found->value *= share;
  }
  return numbers;
}

double estimate_seconds(const SolveConfig& config, const std::optional<Material>& material,
                        const Find& where) {
  const auto seconds = [&](const SolveConfig& scene) {
    const Forecast f = forecast_of(scene, material, where);
    return f.seconds() - 0.6 * f.files;  // no files, and no stability
  };
  double sum = 0;
  if (config.in_motion()) {
    for (const LongerScene& scene : longer_in_space_and_time(config, where))
      sum += seconds(scene.config);
    return sum;
  }
  const Refinements refined = refinements(config, where);
  if (refined.per_change != 0) sum = seconds(refined.other_increments);
  for (const auto* scenes : {&refined.hex8, &refined.hex27})
    for (const SolveConfig& scene : *scenes) sum += seconds(scene);
  for (const auto& [truncation, scenes] : refined.wider)
    for (const SolveConfig& scene : scenes) sum += seconds(scene);
  return sum;
}

}  // namespace langer
