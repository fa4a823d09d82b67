// What an indenter that is pushed costs beside one that is moved: the same curve in the same
// increments.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/stopwatch.hpp"
#include "core/config/reader.hpp"
#include "scene/model/make_mesh.hpp"
#include "scene/run/run.hpp"

using namespace langer;

namespace {

const auto nowhere = [](const std::string&) {
  return Place{};
};

struct Curve {
  std::vector<double> t, travel, force;
  double seconds = std::numeric_limits<double>::infinity();
  int iterations = 0, factorizations = 0;
};

Curve along(const SolveConfig& config, const Mesh& mesh, double depth) {
  Curve best;
  for (int turn = 0; turn < 3; ++turn) {
    const double begun = cpu_seconds();
    const Scene scene = make_scene(config, mesh, config.material, nowhere);
    Run run(mesh, scene, ReducedScene::find(config.symmetry, mesh, scene, nowhere), config.path,
            config.solver);
    Curve curve;
    RunListener each;
    each.of_whole = [&](const StepRecord& step, const SolveReport& report) {
      curve.t.push_back(step.t), curve.force.push_back(std::abs(step.force_ind[1]));
      const auto travel = step.scalars.find("travel_sphere");
      curve.travel.push_back(travel == step.scalars.end() ? depth * step.t : travel->second);
      curve.iterations += report.iterations + report.again;
    };
    const RunEnd end = run.follow(each);
    if (!end.path.complete) throw std::runtime_error(end.path.why);
    curve.seconds = cpu_seconds() - begun,
    curve.factorizations = run.increment.cost().factorizations;
    if (curve.seconds < best.seconds) best = curve;
  }
  return best;
}

void beside(const char* name, const std::string& text, double depth) {
  SolveConfig config = read_config<SolveConfig>(parse_yaml(text, "scene.yaml")).config;
  const Mesh mesh = make_mesh(*config.mesh, nowhere).mesh;
  const Curve moved = along(config, mesh, depth);
  ContactConfig& sphere = config.contacts.at("sphere");
  sphere.motion.clear();
  sphere.control.emplace();
  for (std::size_t i = 0; i < moved.t.size(); ++i)
    sphere.control->force.points.push_back({moved.t[i], moved.force[i]});
  const Curve pushed = along(config, mesh, depth);
  double apart = 0;
  for (std::size_t i = 0; i < std::min(moved.t.size(), pushed.t.size()); ++i)
    apart = std::max(apart, std::abs(pushed.travel[i] - moved.travel[i]));
  fmt::print("{}: {} cells, {} increments, {:.4g} N; travels {:.1e} mm apart\n", name,
             mesh.n_cells(), moved.t.size(), moved.force.back(), apart);
  for (const auto& [how, curve] : {std::pair("moved ", &moved), {"pushed", &pushed}})
    fmt::print("  {} {:.2f} s CPU, {} iterations, {} factorizations\n", how, curve->seconds,
               curve->iterations, curve->factorizations);
  fmt::print("  pushed over moved: {:.3f}\n", pushed.seconds / moved.seconds);
  std::fflush(stdout);
}

}  // namespace

void measure_control() {
  const std::string skin =
      "material: {matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, fibres: [{hgo: {c1: -0.317, c2: 0.319}, alpha: 60}], volume: "
      "{quadratic: {d: 1.0e-6}}}\n";
  const std::string under =
      "  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 2.8}}}}\nsupports: [{on: bottom, hold: [x, y, z]}]\n";
  const auto ball = [](const char* friction, const char* to) {
    return fmt::format(
        "contacts: {{sphere: {{on: contact, rigid: {{sphere: {{radius: 2.5, centre: [0, 6.5, 0]}}}}, friction: {}, motion: [{{t: 1, to: "
        "[0, {}, 0]}}]}}}}\n",
        friction, to);
  };
  const std::string papers =
      "mesh:\n  geometry: {block: {origin: [-15, 0, -15], size: [30, 4, 30], divisions: [22, 5, 22], centre: {edge: 0.36, within: 2.2}, "
      "top: {edge: 0.5}}}\n" +
      under + skin + "path: {steps: 20}\n";
  beside("the paper's scene", papers + ball("0.34", "-1"), 1);
  beside(
      "without friction, on a section",
      "mesh:\n  geometry: {indented_disc: {size: [16, 4], radius: 2.5, depth: 1, edge: 0.05}}\n" +
          under +
          "material: {matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, volume: {quadratic: {d: 1.0e-6}}}\npath: {steps: 20}\n" +
          ball("0", "-1"),
      1);
}
