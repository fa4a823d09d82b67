// A ball that bounces from a section of soft tissue, solved without a file.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "accuracy/estimate/impact_errors.hpp"
#include "scene/model/make_mesh.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/impact_results.hpp"

namespace langer::test {

inline Place no_place(const std::string&) { return {}; }

struct FlyingBall {
  double radius = 2.5;  // [mm]
  double speed = 300;   // [mm/s]
  double mass = 2;      // [g]
};

// n: elements over the depth of 4 mm; how: `step: ...` or `error: ...`
inline SolveConfig bounce(int n, const FlyingBall& ball, const std::string& how) {
  const std::string text = fmt::format(
      "mesh:\n  geometry: {{section: {{of: axisymmetric, size: [6, 4], divisions: [{}, {}]}}}}\n"
      "  sets: {{contact: {{of: top, within: {{box: {{from: [0, 3.9, -1], to: [2.4, 4.1, 1]}}}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y, z]}}]\n"
      "material: {{matrix: {{yeoh: {{a1: 0.05, a2: 0.03}}}}, volume: {{quadratic: {{d: 0.1}}}}}}\n"
      "contacts: {{ball: {{on: contact, rigid: {{sphere: {{radius: {}, centre: [0, {}, 0]}}}},\n"
      "  free: {{mass_g: {}, velocity: [0, {}, 0]}}}}}}\n"
      "dynamics: {{density_kg_m3: 1100, {}}}\npath: {{seconds: 9.0e-3}}\nestimate: refinement\n",
      3 * n / 2, n, ball.radius, 4.02 + ball.radius, ball.mass, -ball.speed, how);
  return read_config<SolveConfig>(parse_yaml(text, "scene.yaml")).config;
}

struct Impact {
  std::vector<Summary> results;
  std::vector<StepForces> path;

  double of(const std::string& name) const {
    for (const Summary& one : results) {
      if (one.name == name) return one.value;
    }
    throw std::runtime_error("no result " + name);
  }
};

inline Impact impact_of(const SolveConfig& config) {
  Run run(make_mesh(*config.mesh, no_place).mesh, config, config.material, no_place);
  ImpactResults results(run.scene, run.inertia.get());
  Impact out;
  RunListener each;
  each.of_whole = [&](StepRecord& step, const SolveReport&) {
    results.add(step);
    append_step(out.path, step_forces(config, run.scene, run.mesh, step));
  };
  const RunEnd end = run.follow(each);
  if (!end.path.complete) throw std::runtime_error(end.path.why);
  out.results = results.summary();
  return out;
}

inline std::vector<ErrorEstimate> errors_of(const SolveConfig& config, const Impact& impact) {
  const auto no_listener = [](const Run&, int, int) {
    return RunListener{};
  };
  return impact_errors(config, config.material, no_place, impact.results, impact.path, no_listener)
      .at_end;
}

}  // namespace langer::test
