// Estimated errors against true ones.
#include "scene/error_estimate.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "config/reader.hpp"
#include "config/tree.hpp"
#include "post/recovery.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace {

const auto nowhere = [](const std::string&) { return Place{}; };

SolveConfig rung(const std::string& scene, double edge, double step) {
  const std::string folder = std::string(SOURCE_DIR) + "/configs/solve";
  const std::string text = "include: trade_" + scene + ".yaml\nmesh: {include: ../mesh/trade.yaml}\n";
  SolveConfig config = read_config<SolveConfig>(parse_yaml(text, folder + "/rung.yaml", folder)).config;
  config.mesh->cells = CellType::hex27;
  std::get<IndentedBlock>(config.mesh->geometry).edge = edge;
  config.path.first = config.path.largest = step;
  return config;
}

const Valued& of(const std::vector<Valued>& all, const std::string& name) {
  return *std::find_if(all.begin(), all.end(), [&](const Valued& v) { return v.name == name; });
}

}  // namespace

TEST_CASE("the estimated error of the force is within a factor of three of the true one") {
  struct Case {
    const char* scene;
    double edge, step, right;  // right: pipelines/trade.yaml, the limit of meshes of either kind
  };
  for (const Case& c : {Case{"isotropic", 0.3536, 0.25, 10.7676}, {"isotropic", 0.25, 0.25, 10.7676}}) {
    CAPTURE(c.scene);
    CAPTURE(c.edge);
    const SolveConfig config = rung(c.scene, c.edge, c.step);
    const std::vector<Valued> found = end_of_path(config, config.material, nowhere);
    const std::vector<ErrorEstimate> estimates = estimate_errors(config, config.material, nowhere, found, 1e-9);
    REQUIRE(estimates.size() == found.size());
    CHECK(estimates[0].of.name == "force");
    const double error = std::abs(of(found, "force").value - c.right);
    CHECK(estimates[0].total() < 3 * error);
    CHECK(estimates[0].total() > error / 3);
    CHECK(estimates[0].solver < 1e-7);
    if (c.edge < 0.3) CHECK(std::abs(estimates[0].limit() - c.right) < 0.002 * c.right);  // coarser ones do not approach it yet
    CHECK(estimates[0].increments == 0);  // no friction
  }
}

TEST_CASE("two meshes that agree by chance do not pass for right") {
  const SolveConfig config = rung("isotropic", 0.5, 0.25);  // 0.06 % off
  const auto estimates = estimate_errors(config, config.material, nowhere, end_of_path(config, config.material, nowhere), 0);
  CHECK(estimates[0].total() > 0.002 * 10.7676);
}

TEST_CASE("with friction the increments have an error, which falls with them") {
  double last = 1e300;
  for (double step : {1.0, 0.5, 0.25}) {
    const SolveConfig config = rung("table1", 0.8, step);
    const auto estimates = estimate_errors(config, config.material, nowhere, end_of_path(config, config.material, nowhere), 0);
    const double increments = std::abs(estimates[0].increments);
    CHECK(increments > 0);
    CHECK(increments < last);
    last = increments;
  }
}

TEST_CASE("a mesh whose cells no number scales has no second rung") {
  SolveConfig config = rung("isotropic", 0.8, 1);
  config.mesh->geometry = Block{};
  CHECK_THROWS_AS(estimate_errors(config, config.material, nowhere, {}, 0), Failure);
}

// a bar of 4 x 1 x 1 mm, held at its ends, which move past each other
TEST_CASE("what a stress lacks to be smooth tells the error of the stored energy within a factor of three") {
  struct Bar {
    RecoveredError error;
    double energy;
  };
  const auto bar = [](int per_mm, const char* cells) {
    const SolveConfig config = test::config_of(fmt::format(
        "mesh: {{cells: {}, geometry: {{block: {{size: [4, 1, 1], divisions: [{}, {}, {}]}}}}}}\n"
        "material: {{matrix: {{yeoh: {{a1: 0.3, a2: 0.1, a3: 0}}}}, volume: {{quadratic: {{d: 1.0e-4}}}}}}\n"
        "supports: [{{on: x_min, hold: [x, y, z]}}, {{on: x_max, hold: [x, z]}}]\n"
        "loads: [{{on: x_max, displacement: {{y: 0.8}}}}]\npath: {{first: 0.5, largest: 0.5}}\n",
        cells, 4 * per_mm, per_mm, per_mm));
    const Mesh mesh = test::mesh_in(config);
    const Scene scene = make_scene(config, mesh, config.material, nowhere);
    const StepRecord last = test::solved(mesh, scene, std::nullopt, {config.path, config.solver}).last();
    return Bar{recovered_error(Body(mesh, scene.materials, scene.formulation), last.u), last.scalars.at("energy")};
  };
  const double right = bar(6, "hex27").energy;
  double before = 1;
  for (int per_mm : {2, 4, 8}) {
    CAPTURE(per_mm);
    const Bar here = bar(per_mm, "hex8");
    const double true_error = here.energy / right - 1;
    CHECK(here.error.energy_share() < 3 * true_error);
    CHECK(here.error.energy_share() > true_error / 3);
    CHECK(here.error.energy_share() < 0.5 * before);
    before = here.error.energy_share();
  }
}

TEST_CASE("a homogeneous state has no error to recover") {
  const SolveConfig config = test::config_of(
      "mesh: {geometry: {block: {size: [2, 1, 1], divisions: [3, 2, 2]}}}\n"
      "material: {matrix: {yeoh: {a1: 0.3, a2: 0.1, a3: 0}}, volume: {quadratic: {d: 1.0e-4}}}\n"
      "supports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: z_min, hold: [z]}]\n"
      "loads: [{on: x_max, displacement: {x: 0.6}}]\npath: {first: 1, largest: 1}\n");
  const Mesh mesh = test::mesh_in(config);
  const Scene scene = make_scene(config, mesh, config.material, nowhere);
  const StepRecord last = test::solved(mesh, scene, std::nullopt, {config.path, config.solver}).last();
  const RecoveredError error = recovered_error(Body(mesh, scene.materials, scene.formulation), last.u);
  CHECK(error.eta < 1e-6);
  CHECK(error.von_mises_spread < 1e-6 * error.von_mises_max);
}
