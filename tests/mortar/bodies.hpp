// Scenes of several bodies solved in memory.
#pragma once

#include <doctest/doctest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "scene/model/scene_bodies.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/run.hpp"

namespace langer::test {

struct BodiesScene {
  SolveConfig config;
  Where where;
  Mesh mesh;
};

inline BodiesScene bodies_scene(const std::string& text) {
  auto loaded = read_config<SolveConfig>(parse_yaml(text, "scene.yaml"));
  BodiesScene scene{std::move(loaded.config), std::move(loaded.where), {}};
  expand_bodies(scene.config, scene.where.tree);
  scene.mesh = mesh_of_bodies(scene.config, scene.where);
  return scene;
}

struct BodiesSolution {
  std::vector<StepRecord> steps;
  Increment::Cost cost;
  int iterations = 0;
  RunEnd::At at = RunEnd::At::the_end;
  const StepRecord& last() const { return steps.back(); }
};

using BodiesListener = std::function<void(const Run&, const StepRecord&)>;

inline BodiesSolution solved(const BodiesScene& scene, const BodiesListener& each = {},
                             const StepRecord* from = nullptr, const StepRecord* before = nullptr) {
  Run run(scene.mesh, scene.config, scene.config.material, scene.where);
  if (from) run.resume(*from, before ? std::optional(*before) : std::nullopt);
  BodiesSolution out;
  RunListener listener;
  listener.of_whole = [&](const StepRecord& step, const SolveReport& report) {
    out.steps.push_back(step);
    out.iterations += report.iterations;
    if (each) each(run, step);
  };
  const RunEnd end = run.follow(listener);
  CAPTURE(end.path.why);
  out.at = end.at;
  out.cost = run.increment.cost();
  CHECK(out.at == RunEnd::At::the_end);
  REQUIRE(!out.steps.empty());
  return out;
}

// force and moment of all contact forces of a step, relative to the forces; supports have no share
inline std::pair<double, double> imbalance(const BodiesScene& scene, const StepRecord& step,
                                           const std::vector<int>& contact_nodes) {
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  double size = 0;
  for (int node : contact_nodes) {
    const auto n = static_cast<std::size_t>(node);
    const Vec3 x = scene.mesh.X[n] + step.u[n];
    force += step.reaction[n];
    moment += cross(x, step.reaction[n]);
    size += step.reaction[n].norm();
  }
  return {force.norm() / size, moment.norm() / size};
}

}  // namespace langer::test
