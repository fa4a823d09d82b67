#include "scene/run/step_forces.hpp"

#include <algorithm>
#include <cmath>

#include "core/tensor/stress.hpp"
#include "mechanics/mesh/section.hpp"
#include "results/post/energy_columns.hpp"
#include "results/post/nodal_fields.hpp"
#include "scene/model/torque.hpp"

namespace langer {

std::set<std::string> moved_sets(const SolveConfig& config) {
  std::set<std::string> moved;
  for (const LoadConfig& load : config.loads)
    for (int axis = 0; axis < 3; ++axis)
      if (const auto to = load.imposed(axis); to && to->moves()) moved.insert(load.on);
  return moved;
}

namespace {

double force_of(const StepRecord& state, const std::string& contact) {
  Vec3 force;
  for (int j = 0; j < 3; ++j) force[j] = state.scalars.at("force_" + contact + "_" + "xyz"[j]);
  return force.norm();
}

void count_touching(const Scene& scene, const Mesh& mesh, const StepRecord& whole,
                    StepForces& forces) {
  int front = mesh.n_nodes();
  if (mesh.section) front = n_front(mesh);
  for (const RigidContact& contact : scene.contacts) {
    const std::vector<Vec3>& r = whole.contacts.at(contact.name).r;
    double n = 0;
    for (std::size_t i = 0; i < r.size(); ++i) {
      if (contact.nodes[i] < front && !r[i].isZero(0)) ++n;
    }
    if (n == 0) continue;
    if (scene.contacts.size() > 1) forces.touching["force_" + contact.name] = n;
    const auto [fewest, first] = forces.touching.try_emplace("force", n);
    fewest->second = std::min(fewest->second, n);
  }
  for (const SurfaceContact& surface : scene.surfaces) {
    const std::vector<Vec3>& r = whole.contacts.at(surface.name).r;
    const auto n = std::ranges::count_if(r, [](const Vec3& one) { return !one.isZero(0); });
    if (n > 0) forces.touching["force_" + surface.name] = static_cast<double>(n);
  }
}

// The pull of the bonds of all indenters and surfaces that adhere, the greatest of them, and how
// many nodes of the front of a section (of a block all) it comes from.
void add_pull(const Scene& scene, const Mesh& mesh, const StepRecord& whole, StepForces& forces) {
  int front = mesh.n_nodes();
  if (mesh.section) front = n_front(mesh);
  const auto count = [&](const std::vector<int>& nodes, const ContactRecord& record, double pull) {
    double n = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const bool bears = !record.r[i].isZero(0) || !record.adhesive[i].isZero(0);
      if (nodes[i] < front && bears) ++n;
    }
    forces.pull = std::max(forces.pull, pull);
    forces.of["pull_off"] = forces.pull;
    forces.touching["pull_off"] = std::max(forces.touching["pull_off"], n);
  };
  for (const SurfaceContact& surface : scene.surfaces) {
    const ContactRecord& record = whole.contacts.at(surface.name);
    if (record.adhesive.empty()) continue;
    const auto averages = mortar_nodes(surface, positions(mesh, whole.u));
    count(surface.nodes, record, pull_force(averages, record.r, record.adhesive));
  }
  for (const RigidContact& contact : scene.contacts) {
    const ContactRecord& record = whole.contacts.at(contact.name);
    if (record.adhesive.empty()) continue;
    double travel = 0;
    if (contact.control) travel = whole.scalars.at("travel_" + contact.name);
    const Vec3 at = indenter_displacement(contact, load_factor_of(whole), travel);
    const double pull = pull_force(contact, mesh, whole.u, record.r, record.adhesive, at);
    count(contact.nodes, record, pull);
  }
}

double apex_height(const Mesh& mesh, const std::vector<Vec3>& u) {
  const auto point = mesh.node_sets.find("apex");
  if (point != mesh.node_sets.end() && point->second.size() == 1)
    return u[static_cast<std::size_t>(point->second[0])][1];
  double highest = 0;
  const auto top = mesh.node_sets.find("top");
  if (top == mesh.node_sets.end()) return 0;
  for (int node : top->second) highest = std::max(highest, u[static_cast<std::size_t>(node)][1]);
  return highest;
}

// What a config asks an accuracy of, beside forces.
void add_asked(const SolveConfig& config, const Scene& scene, const Mesh& mesh,
               const StepRecord& whole, StepForces& forces) {
  if (!config.accuracy || !config.accuracy->of) return;
  const std::string asked = *config.accuracy->quantity();
  if (asked == "apex_height") forces.of[asked] = apex_height(mesh, whole.u);
  if (asked == "von_mises_max" && !has_viscous_law(scene))
    forces.of[asked] = largest_von_mises(scene, mesh, whole.u);
  if (!asked.starts_with("displacement")) return;
  for (const auto& [name, nodes] : mesh.node_sets) {
    const std::string quantity = "displacement_" + name;
    if (nodes.size() != 1 || !(asked == "displacement" || asked == quantity)) continue;
    forces.of[quantity] = whole.u[static_cast<std::size_t>(nodes[0])].norm();
  }
}

// Between two steps linear, 0 at t = 0 and for a name that is not there.
template <class Values>
double between(const std::vector<StepForces>& path, const std::string& name, double t,
               const Values& values) {
  const auto value = [&](const StepForces& step) {
    const auto& of = values(step);
    const auto found = of.find(name);
    return found == of.end() ? 0 : found->second;
  };
  double t0 = 0, f0 = 0;
  for (const StepForces& step : path) {
    const double f = value(step);
    if (t <= step.t) return f0 + (t - t0) / (step.t - t0) * (f - f0);
    t0 = step.t;
    f0 = f;
  }
  return f0;
}

}  // namespace

StepForces step_forces(const SolveConfig& config, const Scene& scene, const Mesh& mesh,
                       const StepRecord& whole) {
  StepForces forces{whole.t, {}};
  if (!scene.contacts.empty()) forces.of["force"] = whole.force_ind.norm();
  if (scene.contacts.size() > 1)
    for (const RigidContact& contact : scene.contacts)
      forces.of["force_" + contact.name] = force_of(whole, contact.name);
  for (const SurfaceContact& surface : scene.surfaces)
    forces.of["force_" + surface.name] = force_of(whole, surface.name);
  for (const RigidContact& contact : scene.contacts)
    if (contact.control)
      forces.of["travel_" + contact.name] = std::abs(whole.scalars.at("travel_" + contact.name));
  count_touching(scene, mesh, whole, forces);
  forces.of.merge(torques_of(whole, scene));
  for (const std::string& set : moved_sets(config)) {
    Vec3 reaction = Vec3::Zero();
    for (int n : mesh.node_sets.at(set)) reaction += whole.reaction[static_cast<std::size_t>(n)];
    forces.of["reaction_" + set] = reaction.norm();
  }
  add_pull(scene, mesh, whole, forces);
  add_asked(config, scene, mesh, whole, forces);
  return forces;
}

void append_step(std::vector<StepForces>& path, StepForces step) {
  const auto pull = step.of.find("pull_off");
  if (pull != step.of.end() && !path.empty()) {
    const StepForces& before = path.back();
    if (before.of.at("pull_off") > pull->second) {
      pull->second = before.of.at("pull_off");
      step.touching["pull_off"] = before.touching.at("pull_off");
    }
  }
  path.push_back(std::move(step));
}

double pull_between_steps(const std::vector<StepForces>& path) {
  std::size_t top = 0;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].pull > path[top].pull) top = i;
  if (top == 0 || top + 1 >= path.size()) return 0;
  const StepForces& here = path[top];
  const double left = (here.pull - path[top - 1].pull) / (here.t - path[top - 1].t);
  const double right = (path[top + 1].pull - here.pull) / (path[top + 1].t - here.t);
  const double curvature = (right - left) / (path[top + 1].t - path[top - 1].t);
  if (!(curvature < 0)) return 0;
  const double slope = left + curvature * (here.t - path[top - 1].t);
  const double parabola = -0.25 * slope * slope / curvature;
  // Where bonds jump right after the greatest pull, the parabola says little: in front of a jump
  // the pull goes on rising as before, at most.
  const double on_as_before = left * (path[top + 1].t - here.t);
  double before_the_top = 0;
  if (top > 1) {
    const StepForces& earlier = path[top - 2];
    const StepForces& before = path[top - 1];
    const double rise = (before.pull - earlier.pull) / (before.t - earlier.t);
    before_the_top = rise * (here.t - before.t) - (here.pull - before.pull);
  }
  return std::min(parabola, std::max(on_as_before, before_the_top));
}

bool has_viscous_law(const Scene& scene) { return ViscousPoints::needed(scene.materials); }

LargestStress largest_von_mises_at(const Scene& scene, const Mesh& mesh,
                                   const std::vector<Vec3>& u) {
  const Body body(mesh, scene.materials, scene.directions, scene.formulation);
  const GaussValues gauss = gauss_values(body, u);
  LargestStress most;
  for (int n = 0; n < mesh.n_nodes(); ++n) {
    const double here = von_mises(sigma_of(node_values(body, n, gauss, StressAt::nodal_average)));
    if (here > most.value) most = {here, n};
  }
  return most;
}

double largest_von_mises(const Scene& scene, const Mesh& mesh, const std::vector<Vec3>& u) {
  return largest_von_mises_at(scene, mesh, u).value;
}

double force_at(const std::vector<StepForces>& path, const std::string& name, double t) {
  return between(
      path, name, t, [](const StepForces& step) -> const auto& { return step.of; });
}

double touching_at(const std::vector<StepForces>& path, const std::string& name, double t) {
  return between(
      path, name, t, [](const StepForces& step) -> const auto& { return step.touching; });
}

RunListener collecting(RunListener listener, const SolveConfig& config, const Run& run,
                       std::vector<StepForces>& path) {
  listener.of_whole = [&, also = std::move(listener.of_whole)](StepRecord& whole,
                                                               const SolveReport& report) {
    if (also) also(whole, report);
    append_step(path, step_forces(config, run.scene, run.mesh, whole));
  };
  return listener;
}

}  // namespace langer
