#include "scene/run/motion_record.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "results/store/solution_layout.hpp"
#include "scene/model/scene_motion.hpp"
#include "scene/run/by_node.hpp"
#include "scene/run/step_record.hpp"

namespace langer {

std::unique_ptr<Inertia> inertia_of(const Reduction& reduction, Assembler& body,
                                    const LoadPathOptions& path, const Place& place) {
  const Scene& scene = reduction.scene();
  if (!scene.motion) return nullptr;
  InertiaOptions options = *scene.motion;
  options.seconds = path.seconds.value_or(1);
  if (!options.massless.empty()) {
    options.massless.assign(body.mesh().X.size(), 0);
    for (const RigidContact& contact : scene.contacts) {
      for (int node : contact.nodes) options.massless[static_cast<std::size_t>(node)] = 1;
    }
    for (const SurfaceContact& surface : scene.surfaces) {
      for (int node : surface.all_nodes) options.massless[static_cast<std::size_t>(node)] = 1;
    }
  }
  std::unique_ptr<Inertia> inertia;
  try {
    inertia = std::make_unique<Inertia>(body, std::move(options));
  } catch (const std::invalid_argument& refused) {
    throw Failure(Exit::config, Error{place, "dynamics.contact_mass", refused.what(),
                                      "at least four cells across the body, or kept",
                                      "nodes that may touch lose their mass to those behind"});
  }
  body.set_added_term(inertia.get());
  return inertia;
}

LoadPathOptions motion_path(const Scene& scene, LoadPathOptions path) {
  if (!scene.motion) return path;
  if (scene.motion_step) {
    path.fixed = std::min(1.0, *scene.motion_step / path.seconds.value_or(1));
    path.smallest = std::min(path.smallest, path.fixed / 64);
    return path;
  }
  // The first increment is not known; a failed attempt costs less than one that is far too short.
  if (path.steps) return path;
  path.first = std::min(path.first, 1e-3);
  path.smallest = std::min(path.smallest, 1e-7);
  return path;
}

void record_motion(const Increment& increment, const Assembler& body, StepRecord& record) {
  const MotionState& motion = increment.accepted().motion;
  const auto nodal = [&](const VecX& all) {
    std::vector<Vec3> out = by_node(all);
    hang(body, all, out);
    return out;
  };
  record.point_fields[velocity_field] = nodal(motion.v);
  record.point_fields[acceleration_field] = nodal(motion.a);
  record.point_fields[carried_field] = nodal(motion.b);
  auto& scalars = record.scalars;
  scalars["energy"] = motion.stored;
  scalars["mechanical_energy"] = motion.total;
  scalars["damped_energy"] = motion.damped;
  scalars["energy_balance"] = motion.balance;
  const Inertia& inertia = *increment.inertia();
  const Inertia::StartValues& start = inertia.start_values();
  const auto now_and_at_start = [&](const std::string& name, double now, double at_start) {
    scalars[name] = now;
    scalars[name + solution::at_start_suffix] = at_start;
  };
  const auto along_axes = [&](const std::string& name, const Vec3& now, const Vec3& at_start) {
    for (int k = 0; k < 3; ++k) now_and_at_start(name + "_" + "xyz"[k], now[k], at_start[k]);
  };
  now_and_at_start("kinetic_energy", motion.kinetic, start.kinetic);
  along_axes("momentum", inertia.momentum(motion), start.momentum);
  const std::vector<MovingBody>& bodies = inertia.options().bodies;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    along_axes("momentum_" + bodies[i].name, inertia.momentum(motion, bodies[i]),
               start.momentum_of[i]);
  }
  if (inertia.options().travel_mass > 0) {
    now_and_at_start(indenter_velocity, motion.travel_v, start.travel_v);
    scalars[indenter_acceleration] = motion.travel_a;
    scalars[indenter_carried] = motion.travel_b;
  }
}

}  // namespace langer
