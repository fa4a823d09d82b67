// KINSOL as an equal: every shipped scene, on a mesh of few cells, goes where newton goes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "scene/model/scene.hpp"
#include "scene/model/solve_config_io.hpp"
#include "support/solved_scene.hpp"

using namespace langer;
namespace fs = std::filesystem;

namespace {

const std::string configs = SOURCE_DIR "/configs/";

Mesh mesh_of(const std::string& text) {
  return make_mesh(read_config<MeshConfig>(parse_yaml(text, "mesh.yaml", configs + "mesh")).config,
                   test::nowhere)
      .mesh;
}

// what fits a scene: its own section, or few cells with the sets that it names
Mesh mesh_for(const std::string& name, const SolveConfig& config) {
  if (config.mesh) return test::mesh_in(config);
  if (name == "suction_angles")
    return mesh_of(
        "{geometry: {block: {origin: [-10, 0, -10], size: [20, 4, 20], divisions: [8, 2, 8]}}, "
        "sets: {hole: {of: top, within: {cylinder: {axis: y, radius: 3.6}}}, "
        "ring: {of: top, within: {cylinder: {axis: y, radius: 8, beyond: 3.6}}}}}");
  if (name == "twist")
    return mesh_of(
        "{geometry: {block: {origin: [-8, 0, -8], size: [16, 4, 16], divisions: [8, 2, 8]}}, "
        "sets: {disc: {of: top, within: {cylinder: {axis: y, radius: 3}}}}}");
  if (name == "scratch")
    return mesh_of(
        "{geometry: {block: {origin: [-8, 0, -8], size: [16, 4, 16], divisions: [14, 3, 14], centre: {edge: 0.6, within: 3}}}, "
        "sets: {track: {of: top, within: {box: {from: [-3.7, 4, -2.2], to: [3.7, 4, 2.2]}}}}}");
  if (!config.contacts.empty()) return mesh_of("{include: smoke.yaml}");
  return mesh_of("{include: cube_1_8.yaml}");
}

}  // namespace

TEST_CASE("every shipped scene goes with KINSOL where it goes with newton") {
  const Material skin =
      read_config<Material>(load_yaml(configs + "material/abdomen_hgo_yeoh.yaml")).config;
  int scenes = 0;
  std::set<fs::path> files;
  for (const auto& entry : fs::directory_iterator(configs + "solve")) files.insert(entry.path());
  for (const fs::path& file : files) {
    const std::string name = file.stem();
    if (name.starts_with("accuracy_")) continue;  // those of refinement_ on meshes of their own
    if (name.starts_with("which_")) continue;     // the others' scenes on one skin
    if (name == "dynamic_indentation") continue;  // pressed as in indentation_creep, on more cells
    CAPTURE(name);
    Tree tree = load_yaml(file.string());
    if (name == "suction_plate")
      set_value(tree, "mesh.geometry.section.divisions", parse_yaml("[48, 16]", "fewer"));
    const SolveConfig config = read_config<SolveConfig>(tree).config;
    // Bonds, inertia, given volumes and surfaces that touch are solved by newton alone.
    SolveConfig by_kinsol = config;
    by_kinsol.solver = KinsolOptions{};
    if (!by_kinsol.complaints().empty()) continue;
    const Mesh mesh = mesh_for(name, config);
    Material given = config.material ? *config.material : skin;
    if (mesh.section && !config.material)
      given.fibres.clear();  // forward_uncertainty: sections bear none along x
    const Scene scene = make_scene(config, mesh, given, test::nowhere);
    const auto part = ReducedScene::find(config.symmetry, mesh, scene, test::nowhere);
    test::HowToSolve how;
    how.path = config.path;
    how.path.use_increment(
        name == "scratch"
            ? 0.05
            : 0.2);  // few: else iterations decide on them, and friction remembers its way
    if (config.path.seconds) how.path.steps = 4;  // in each stage
    how.solver = NewtonOptions{.relative = 1e-10};
    const std::vector<StepRecord> expected = solved(mesh, scene, part, how).steps;
    double size = 0;
    for (const StepRecord& step : expected)
      for (const Vec3& u : step.u) size = std::max(size, u.norm());
    constexpr KinsolStrategy in_turn[] = {KinsolStrategy::linesearch, KinsolStrategy::picard,
                                          KinsolStrategy::fixed_point};
    for (KinsolStrategy strategy : {KinsolStrategy::newton, in_turn[scenes % 3]}) {
      CAPTURE(static_cast<int>(strategy));
      how.solver = KinsolOptions{.strategy = strategy, .relative = 1e-10};
      const std::vector<StepRecord> found = solved(mesh, scene, part, how).steps;
      // with a tangent of before the remainder's modulus of hex27 follows round by round:
      // increments may have to be shorter
      const bool follows =
          scene.formulation == Formulation::linear_dilatation && strategy >= KinsolStrategy::picard;
      if (!follows) REQUIRE(found.size() == expected.size());
      double most = 0;
      for (const StepRecord& step : expected) {
        const auto same = std::find_if(found.begin(), found.end(), [&](const StepRecord& s) {
          return std::abs(s.t - step.t) < 1e-12;
        });
        REQUIRE(same != found.end());
        for (std::size_t i = 0; i < step.u.size(); ++i)
          most = std::max(most, (same->u[i] - step.u[i]).norm());
      }
      CHECK(most <= 1e-8 * size);
      MESSAGE(name << ": u differs by " << most / size << " of its largest");
    }
    ++scenes;
  }
  CHECK(scenes >= 14);
}
