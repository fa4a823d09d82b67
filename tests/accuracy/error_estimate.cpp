// Estimated errors against true ones.
#include "accuracy/estimate/error_estimate.hpp"
#include "accuracy/estimate/least_scatter.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/config/tree.hpp"
#include "results/post/recovery.hpp"
#include "scene/model/solve_config_io.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace error_estimate_tests {

namespace {

const auto nowhere = [](const std::string&) {
  return Place{};
};

SolveConfig level(const std::string& scene, CellType cells, double edge, double step) {
  const std::string folder = std::string(SOURCE_DIR) + "/configs/solve";
  const std::string text =
      "include: refinement_" + scene + ".yaml\nmesh: {include: ../mesh/refinement_study.yaml}\n";
  SolveConfig config =
      read_config<SolveConfig>(parse_yaml(text, folder + "/level.yaml", folder)).config;
  config.mesh->cells = cells;
  std::get<IndentedBlock>(config.mesh->geometry).edge = edge;
  config.path.first = config.path.largest = step;
  return config;
}

std::vector<ErrorEstimate> estimates_of(const SolveConfig& config) {
  return estimate_along(config, config.material, nowhere,
                        solved_path(config, config.material, nowhere), 1e-9)
      .at_end;
}

}  // namespace

// right: make work-precision, the limit of meshes of either kind, 0.03 % and for the others 0.06 %
TEST_CASE(
    "the estimated error of the force is within a factor of three of the true one, and has its sign") {
  struct Case {
    const char* scene;
    CellType cells;
    double edge, right;
  };
  for (const Case& c : {Case{"isotropic", CellType::hex8, 0.35, 10.763},
                        {"isotropic", CellType::hex8, 0.2, 10.763},
                        {"isotropic", CellType::hex27, 0.6, 10.763},
                        {"isotropic", CellType::hex27, 0.3536, 10.763},
                        {"isotropic", CellType::hex27, 0.25, 10.763},
                        {"table1", CellType::hex8, 0.175, 9.362},
                        {"positive", CellType::hex8, 0.2, 12.67}}) {
    CAPTURE(c.scene);
    CAPTURE(static_cast<int>(c.cells));
    CAPTURE(c.edge);
    const SolveConfig config = level(c.scene, c.cells, c.edge, 0.25);
    const std::vector<ErrorEstimate> estimates = estimates_of(config);
    REQUIRE(estimates.size() == 3);  // greatest von Mises stress, displacement of S
    const ErrorEstimate& force = estimates[0];
    CHECK(force.of.name == "force");
    const double error = force.of.value - c.right;
    CHECK(force.total() < 3 * std::abs(error));
    CHECK(force.total() > std::abs(error) / 3);
    CHECK(force.cells * error > 0);
    const bool longest_of_its_own =
        c.cells == CellType::hex8 && c.edge == 0.175;  // their limit is no nearer than this
    CHECK(std::abs(force.limit() - c.right) <
          (longest_of_its_own ? 0.6 * std::abs(error) : 0.002 * c.right));
    CHECK(force.solver < 1e-7);
    if (!has_friction(config)) CHECK(force.increments == 0);
  }
}

TEST_CASE("three meshes that lie on a line by chance do not make a bar that is too short") {
  // cells of 0.08 contact radii: 10.752 N (docs/work_precision.md)
  SolveConfig config = read_config<SolveConfig>(load_yaml(std::string(SOURCE_DIR) +
                                                          "/configs/solve/accuracy_elsewhere.yaml"))
                           .config;
  auto& block = std::get<IndentedBlock>(config.mesh->geometry);
  block.under = {5, 0}, block.edge = 0.175;
  std::get<Sphere>(config.contacts.at("sphere").rigid.value()).centre = {5, 6.5, 0};
  const SolvedPath path = solved_path(config, config.material, nowhere);
  const ErrorEstimate force =
      estimate_along(config, config.material, nowhere, path, 1e-9).at_end[0];
  const double error = std::abs(force.of.value - 10.752);
  CHECK(std::abs(force.cells) < 0.5 * error);  // the fit alone
  CHECK(force.total() > error);
  CHECK(force.total() < 5 * error);
}

TEST_CASE(
    "on cells too long for the shear at the edge of the contact the bar knows it, without a sign") {
  const SolveConfig config = level("positive", CellType::hex8, 0.175, 0.25);
  const SolvedPath path = solved_path(config, config.material, nowhere);
  const ErrorEstimate force =
      estimate_along(config, config.material, nowhere, path, 1e-9).at_end[0];
  const double shear = shear_at_edge(config, touching_at(path.path, "force", 1)) * force.of.value;
  CHECK(force.total() > shear);
  CHECK(std::abs(force.cells) < shear);  // what the meshes tell of it
  CHECK(force.total() > force.of.value - 12.67);
}

// 8.746 N by hex27 of 0.1 contact radii (make adaptive)
TEST_CASE("what touches a punch may end anywhere on a rounding that the cells do not resolve") {
  SolveConfig config = read_config<SolveConfig>(load_yaml(std::string(SOURCE_DIR) +
                                                          "/configs/solve/accuracy_elsewhere.yaml"))
                           .config;
  auto& block = std::get<IndentedBlock>(config.mesh->geometry);
  ContactConfig& punch = config.contacts.at("sphere");
  punch.rigid = Cylinder{2, 0.3, {0, 4, 0}, {0, 1, 0}};
  punch.motion.back().to = {0, -0.5, 0};
  for (double edge : {0.175, 0.125}) {
    CAPTURE(edge);
    block.depth = 0.8, block.edge = edge;
    const SolvedPath path = solved_path(config, config.material, nowhere);
    const ErrorEstimate force =
        estimate_along(config, config.material, nowhere, path, 1e-9).at_end[0];
    CHECK(force.total() > std::abs(force.of.value - 8.746));
    CHECK(force.total() < 8 * std::abs(force.of.value - 8.746));
  }
}

TEST_CASE("on a disc, too, what few nodes in contact get wrong is known") {
  const std::string folder = std::string(SOURCE_DIR) + "/configs/solve";
  for (CellType cells : {CellType::hex8, CellType::hex27}) {
    SolveConfig config = read_config<SolveConfig>(load_yaml(folder + "/axisymmetric.yaml")).config;
    config.mesh->cells = cells;
    std::get<IndentedDisc>(config.mesh->geometry).edge = 0.25;
    const ErrorEstimate force = estimates_of(config)[0];
    const double error = force.of.value - 10.763;  // docs/sections.md, within 0.03 %
    CHECK(std::abs(error) > 0.004 * 10.763);
    CHECK(std::abs(force.limit() - 10.763) < 0.001 * 10.763);
    CHECK(force.total() > std::abs(error));
    CHECK(force.total() < 2 * std::abs(error));
  }
}

TEST_CASE("a formulation that locks is not judged by cells that lock as well") {
  SolveConfig config = level("isotropic", CellType::hex8, 0.175, 0.25);
  config.formulation = Formulation::displacement;
  const ErrorEstimate force = estimates_of(config)[0];
  CHECK(force.of.value > 2 * 10.763);
  CHECK(std::abs(force.limit() - 10.763) < 0.002 * 10.763);
}

TEST_CASE(
    "increments of a viscous body of quadratic cells have an error, without an indenter, too") {
  const SolveConfig config = test::config_of(
      "mesh: {cells: hex27, geometry: {block: {size: [8, 4, 4], divisions: [4, 4, 4]}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1.0e-3}}, viscous: [{tau: 1, gamma: 0.5}]}\n"
      "supports: [{on: x_min, hold: [x, y, z]}]\nloads: [{on: x_max, displacement: {x: 1, y: 0, z: 0}}]\n"
      "path: {seconds: 2, first: 0.25, largest: 0.25}\nstability: off\n");
  const std::vector<ErrorEstimate> estimates = estimates_of(config);
  REQUIRE(!estimates.empty());
  CHECK(estimates[0].of.name == "reaction_x_max");
  CHECK(estimates[0].increments != 0);
  CHECK(std::abs(estimates[0].increments) < 0.1 * estimates[0].of.value);
}

TEST_CASE("two meshes that agree by chance do not pass for right") {
  const ErrorEstimate force = estimates_of(
      level("isotropic", CellType::hex27, 0.5, 0.25))[0];  // 0.03 % off, its neighbours 0.8 and 1.8
  CHECK(force.total() > std::abs(force.of.value - 10.763));
}

TEST_CASE("with friction the increments have an error, which falls with them, without it none") {
  double last = 1e300;
  for (double step : {1.0, 0.5, 0.25}) {
    const double increments =
        std::abs(estimates_of(level("table1", CellType::hex8, 0.15, step))[0].increments);
    CAPTURE(step);
    CHECK(increments > 0);
    CHECK(increments < last);
    last = increments;
    CHECK(estimates_of(level("isotropic", CellType::hex8, 0.18, step))[0].increments == 0);
  }
}

namespace {

// pulled, sheared or pressed between clamped faces; `n`: cells a millimetre
SolveConfig between_clamped_faces(const std::string& load, const std::string& law,
                                  const char* cells, int n) {
  return test::config_of(fmt::format(
      "mesh: {{cells: {}, geometry: {{block: {{size: [4, 2, 1], divisions: [{}, {}, {}]}}}}}}\n"
      "material: {{matrix: {{yeoh: {{a1: 0.1, a2: 0.1, a3: 0}}}}, volume: {{quadratic: {{d: 1.0e-4}}}}{}}}\n"
      "supports: [{{on: x_min, hold: [x, y, z]}}]\n"
      "loads: [{{on: x_max, displacement: {}}}]\npath: {{first: 0.5, largest: 0.5}}\nsymmetry: auto\n",
      cells, 4 * n, 2 * n, n, law, load));
}

}  // namespace

TEST_CASE("the reaction of a clamped body has an error bar that holds, and tells something") {
  const std::string isotropic, fibrous = ", fibres: [{hgo: {c1: 0.1, c2: 0.3}, alpha: 30}]";
  const char *const pulled = "{x: 1.2, y: 0, z: 0}", *const sheared = "{x: 0, y: 0.8, z: 0}",
                    *const pressed = "{x: -0.8, y: 0, z: 0}";
  using Case = std::pair<const char*, std::string>;
  for (const Case& one :
       {Case{pulled, isotropic}, {pulled, fibrous}, {sheared, fibrous}, {pressed, isotropic}}) {
    const char* load = one.first;
    const std::string& law = one.second;
    const auto scene = [&](const char* cells, int n) {
      return between_clamped_faces(load, law, cells, n);
    };
    const auto finest = [&](int n) {
      return end_of_path(scene("hex27", n), scene("hex27", n).material, nowhere)[0].value;
    };
    // behind the finest by as much as it is behind the one before it, more where p = 1, less where
    // p = 2
    const double q = finest(5), unknown = std::abs(q - finest(3)), right = q - unknown;
    for (const auto& [cells, n] : {std::pair{"hex8", 4}, {"hex8", 6}, {"hex27", 4}}) {
      CAPTURE(load);
      CAPTURE(law);
      const auto kind = cells;
      CAPTURE(kind);
      const auto per_mm = n;
      CAPTURE(per_mm);
      const ErrorEstimate reaction = estimates_of(scene(cells, n))[0];
      CHECK(reaction.of.name == "reaction_x_max");
      const double error = std::abs(reaction.of.value - right);
      CAPTURE(error / right);
      CAPTURE(unknown / right);
      CHECK(reaction.total() > error - unknown);
      CHECK(reaction.total() < 8 * (error + unknown));
    }
  }
}

TEST_CASE("a homogeneous body has no error of its cells, and few cells are no estimate") {
  const auto pulled = [](int n) {
    return test::config_of(fmt::format(
        "mesh: {{geometry: {{block: {{size: [2, 1, 1], divisions: [4, 1, {}]}}}}}}\n"
        "material: {{matrix: {{yeoh: {{a1: 0.3, a2: 0.1, a3: 0}}}}, volume: {{quadratic: {{d: 1.0e-4}}}}}}\n"
        "supports: [{{on: x_min, hold: [x]}}, {{on: y_min, hold: [y]}}, {{on: z_min, hold: [z]}}]\n"
        "loads: [{{on: x_max, displacement: {{x: 0.6}}}}]\npath: {{first: 1, largest: 1}}\n",
        n));
  };
  const ErrorEstimate reaction = estimates_of(pulled(4))[0];
  CHECK(reaction.of.name == "reaction_x_max");
  // The coarser meshes are solved until their residual is 1e-5 of the force. What is left differs
  // from mesh to mesh and with the kernels of the BLAS, and counts as cells or as scatter.
  CHECK(reaction.total() < 3e-5 * reaction.of.value);
  CHECK_THROWS_WITH_AS(estimates_of(pulled(3)), doctest::Contains("too few cells along z"),
                       Failure);
}

TEST_CASE("a mesh whose cells follow from no numbers has no refinement to estimate by") {
  SolveConfig config = level("isotropic", CellType::hex27, 0.8, 1);
  config.mesh->geometry = GradedBlock{};
  CHECK_THROWS_AS(estimate_errors(config, config.material, nowhere, {}, 0), Failure);
}

// a bar of 4 x 1 x 1 mm, held at its ends, which move past each other
TEST_CASE(
    "what a stress lacks to be smooth tells the error of the stored energy within a factor of three") {
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
    const StepRecord last =
        test::solved(mesh, scene, std::nullopt, {config.path, config.solver}).last();
    return Bar{
        recovered_error(Body(mesh, scene.materials, scene.directions, scene.formulation), last.u),
        last.scalars.at("energy")};
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
  const StepRecord last =
      test::solved(mesh, scene, std::nullopt, {config.path, config.solver}).last();
  const RecoveredError error =
      recovered_error(Body(mesh, scene.materials, scene.directions, scene.formulation), last.u);
  CHECK(error.eta < 1e-6);
  CHECK(error.von_mises_spread < 1e-6 * error.von_mises_max);
}

TEST_CASE("the greatest von Mises stress at a corner of one cell alone has an error too") {
  const SolveConfig config = test::config_of(
      "mesh: {geometry: {block: {size: [3, 1, 1], divisions: [6, 3, 3]}}}\n"
      "material: {matrix: {yeoh: {a1: 0.3, a2: 0.1, a3: 0}}, volume: {quadratic: {d: 1.0e-3}}}\n"
      "supports: [{on: x_min, hold: [x, y, z]}]\n"
      "loads: [{on: x_max, displacement: {x: 0.3}}]\npath: {first: 1, largest: 1}\n");
  const Mesh mesh = test::mesh_in(config);
  const Scene scene = make_scene(config, mesh, config.material, nowhere);
  const StepRecord last =
      test::solved(mesh, scene, std::nullopt, {config.path, config.solver}).last();
  const RecoveredError error =
      recovered_error(Body(mesh, scene.materials, scene.directions, scene.formulation), last.u);
  CHECK(error.von_mises_spread > 0.05 * error.von_mises_max);
}

}  // namespace error_estimate_tests
