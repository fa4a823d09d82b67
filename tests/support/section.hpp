// Scenes on sections, and under a sphere on a disc or the block of its area, solved in memory.
#pragma once

#include <string>
#include <vector>

#include "support/solved_scene.hpp"

namespace langer::test {

struct Ended {
  Mesh mesh;
  Scene scene;
  std::vector<StepRecord> steps;
  const StepRecord& last() const { return steps.back(); }
  Vec3 reaction(const std::string& set) const {
    Vec3 sum = Vec3::Zero();
    for (int n : mesh.node_sets.at(set)) sum += last().reaction[n];
    return sum;
  }
};

inline Ended run(const SolveConfig& config, const Mesh& mesh) {
  Ended out{mesh, make_scene(config, mesh, config.material, nowhere), {}};
  out.steps = solved(mesh, out.scene, ReducedScene::find(config.symmetry, mesh, out.scene, nowhere),
                     {config.path, config.solver})
                  .steps;
  return out;
}
inline Ended run(const std::string& text) { return run(config_of(text), mesh_in(config_of(text))); }

inline const std::string yeoh =
    "material: {matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, volume: {quadratic: {d: 1.0e-3}}}\n";

inline const std::string tight = "solver: {newton: {relative: 1.0e-12}}\n";

inline std::string indentation(const std::string& geometry, const std::string& more = "") {
  return "mesh:\n  geometry: " + geometry +
         "\n  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 2.8}}}}\n"
         "material: {matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, volume: {quadratic: {d: 1.0e-6}}}\n"
         "supports: [{on: bottom, hold: [x, y, z]}]\n" +
         more;
}
inline std::string ball(double mu, double depth = 1) {
  return "contacts: {ball: {on: contact, rigid: {sphere: {radius: 2.5, centre: [0, 6.5, 0]}}, friction: " +
         std::to_string(mu) + ", motion: [{t: 1, to: [0, " + std::to_string(-depth) +
         ", 0]}]}}\npath: {first: 0.1, largest: 0.25}\n";
}
// of the same area as the block of 30 x 30 mm
inline std::string disc(double edge, const char* cells) {
  return "{indented_disc: {size: [16.925687506432689, 4], radius: 2.5, depth: 1, edge: " +
         std::to_string(edge) + "}}\n  cells: " + cells;
}

}  // namespace langer::test
