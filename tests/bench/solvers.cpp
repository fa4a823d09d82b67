#include "bench/solvers.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/stopwatch.hpp"
#include "scene/model/make_mesh.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/run.hpp"

namespace langer {

namespace {

const std::string strip = R"(
mesh: {geometry: {block: {size: [30, 4, 30], divisions: [14, 4, 14]}}}
material: {matrix: {yeoh: {a1: 0.05, a2: 0.05, a3: 0.02}}, fibres: [{hgo: {c1: 0.1, c2: 0.3}}], volume: {quadratic: {d: 1.0e-6}}}
path: {first: 0.2, largest: 0.2}
)";
const std::string along = strip + R"(
fibre_angles: [0]
supports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: z_min, hold: [z]}]
loads: [{on: x_max, displacement: {x: 9}}]
)";
const std::string across = strip + R"(
fibre_angles: [45]
supports: [{on: x_min, hold: [x, y, z]}]
loads: [{on: x_max, displacement: {x: 9, y: 0, z: 0}}]
)";
const std::string pressed = R"(
mesh:
  geometry: {indented_block: {origin: [-15, 0, -15], size: [30, 4, 30], radius: 2.5, depth: 1, edge: 0.25}}
  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 2.8}}}}
material: {matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, fibres: [{hgo: {c1: -0.317, c2: 0.319}}], volume: {quadratic: {d: 1.0e-6}}}
fibre_angles: [60]
supports: [{on: bottom, hold: [x, y, z]}]
contacts:
  sphere:
    on: contact
    rigid: {sphere: {radius: 2.5, centre: [0, 6.5, 0]}}
    friction: 0.34
    motion: [{t: 1, to: [0, -1, 0]}]
path: {first: 0.1, largest: 0.1}
)";

// a row of the table; u at the end of the path
VecX row(const SolveConfig& config, const Mesh& mesh, const Scene& scene, const std::string& name,
         const std::variant<NewtonOptions, KinsolOptions>& solver) {
  const double began = cpu_seconds();
  Run run(mesh, scene, std::nullopt, config.path, solver);
  int evaluations = 0;
  RunListener count;
  count.failed = [&](double, const SolveReport& report) {
    evaluations += report.evaluations;
  };
  count.of_whole = [&](const StepRecord&, const SolveReport& report) {
    evaluations += report.evaluations;
  };
  const PathReport path = run.follow(count).path;
  fmt::print("| {} | {} | {} | {} | {:.2f} |{}\n", name, path.iterations + path.again, evaluations,
             run.increment.cost().factorizations, cpu_seconds() - began,
             path.complete ? "" : " " + path.why);
  return run.increment.accepted().u;
}

}  // namespace

void measure_solvers() {
  for (const auto& [words, text] : {std::pair{"tension along the fibres", along},
                                    {"tension at 45 degrees, ends clamped", across},
                                    {"indentation, friction", pressed}}) {
    const SolveConfig config = read_config<SolveConfig>(parse_yaml(text, "scene.yaml")).config;
    const auto nowhere = [](const std::string&) {
      return Place{};
    };
    const Mesh mesh = make_mesh(*config.mesh, nowhere).mesh;
    const Scene scene = make_scene(config, mesh, config.material, nowhere);
    fmt::print(
        "{}: {} hexahedra, increments of {:g}\n| solver | iterations | evaluations | factorizations | CPU s |\n",
        words, mesh.n_cells(), config.path.largest);
    const VecX u = row(config, mesh, scene, "newton", NewtonOptions{});
    double differs = 0;
    for (KinsolStrategy strategy : {KinsolStrategy::newton, KinsolStrategy::linesearch,
                                    KinsolStrategy::picard, KinsolStrategy::fixed_point}) {
      KinsolOptions options;
      options.strategy = strategy;
      const VecX other =
          row(config, mesh, scene,
              std::string("kinsol ") + names(strategy)[static_cast<int>(strategy)], options);
      differs = std::max(differs, (other - u).lpNorm<Eigen::Infinity>());
    }
    fmt::print("displacements differ by at most {:.1e} mm\n\n", differs);
  }
}

}  // namespace langer
