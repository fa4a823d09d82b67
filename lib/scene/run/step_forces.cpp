#include "scene/run/step_forces.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/mesh/section.hpp"
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
  return forces;
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
    path.push_back(step_forces(config, run.scene, run.mesh, whole));
  };
  return listener;
}

}  // namespace langer
