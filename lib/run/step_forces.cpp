#include "run/step_forces.hpp"

#include "scene/torque.hpp"

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

}  // namespace

StepForces step_forces(const SolveConfig& config, const Scene& scene, const Mesh& mesh, const StepRecord& whole) {
  StepForces forces{whole.t, {}};
  if (!scene.contacts.empty()) forces.of["force"] = whole.force_ind.norm();
  if (scene.contacts.size() > 1)
    for (const RigidContact& contact : scene.contacts) forces.of["force_" + contact.name] = force_of(whole, contact.name);
  forces.of.merge(torques_of(whole, scene));
  for (const std::string& set : moved_sets(config)) {
    Vec3 reaction = Vec3::Zero();
    for (int n : mesh.node_sets.at(set)) reaction += whole.reaction[static_cast<std::size_t>(n)];
    forces.of["reaction_" + set] = reaction.norm();
  }
  return forces;
}

double force_at(const std::vector<StepForces>& path, const std::string& name, double t) {
  const auto value = [&](const StepForces& step) {
    const auto found = step.of.find(name);
    return found == step.of.end() ? 0 : found->second;
  };
  double t0 = 0, f0 = 0;
  for (const StepForces& step : path) {
    const double f = value(step);
    if (t <= step.t) return f0 + (t - t0) / (step.t - t0) * (f - f0);
    t0 = step.t, f0 = f;
  }
  return f0;
}

RunListener collecting(RunListener listener, const SolveConfig& config, const Run& run, std::vector<StepForces>& path) {
  listener.of_whole = [&, also = std::move(listener.of_whole)](StepRecord& whole, const SolveReport& report) {
    if (also) also(whole, report);
    path.push_back(step_forces(config, run.scene, run.mesh, whole));
  };
  return listener;
}

}  // namespace langer
