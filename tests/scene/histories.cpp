// Histories of imposed displacements: the same states as in proportion to t, in one path with
// kinks.
#include "core/base/history.hpp"

#include <doctest/doctest.h>

#include <random>

#include "results/post/energy_columns.hpp"
#include "scene/model/scene_image.hpp"
#include "scene/run/homogeneous.hpp"
#include "scene/run/post_files.hpp"
#include "support/block.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace histories_tests {

using test::config_of, test::mesh_in, test::nowhere;

namespace {

std::string scene(const std::string& loads, const std::string& more = "") {
  return "mesh: {geometry: {block: {size: [4, 1, 2], divisions: [4, 2, 2]}}}\n"
         "material: {matrix: {yeoh: {a1: 0.05, a2: 0.05, a3: 0.02}}, volume: {quadratic: {d: 1.0e-2}}}\n"
         "supports: [{on: x_min, hold: [x, y, z]}]\nsolver: {newton: {relative: 1.0e-10}}\n"
         "loads: " +
         loads + "\n" + more;
}

test::Solved solved(const std::string& text) {
  const SolveConfig config = config_of(text);
  const Mesh mesh = mesh_in(config);
  const Scene scene = make_scene(config, mesh, config.material, nowhere);
  test::HowToSolve how;
  how.path = config.path, how.solver = config.solver;
  Run run(mesh, scene, ReducedScene::find(config.symmetry, mesh, scene, nowhere), how.path,
          how.solver);
  return test::solved(mesh, scene, ReducedScene::find(config.symmetry, mesh, scene, nowhere), how);
}

const StepRecord& at(const test::Solved& s, double t) {
  for (const StepRecord& step : s.steps)
    if (std::abs(step.t - t) < 1e-9) return step;
  FAIL("no state there");
  return s.last();
}

double apart(const StepRecord& a, const StepRecord& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.u.size(); ++i)
    most = std::max({most, (a.u[i] - b.u[i]).norm(), (a.reaction[i] - b.reaction[i]).norm()});
  return most;
}

}  // namespace

TEST_CASE(
    "a history is 0 at t = 0, meets its points, is straight between them and constant behind the last") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-2, 2);
  for (int draw = 0; draw < 20; ++draw) {
    HistoryConfig config;
    for (double t : {0.2, 0.5, 0.9}) config.points.push_back({t, u(random)});
    const History h = history_of(config, {});
    CHECK(h.at(0) == 0);
    for (std::size_t k = 0; k < 3; ++k) {
      const double t0 = k ? *config.points[k - 1].t : 0, t1 = *config.points[k].t,
                   v0 = k ? config.points[k - 1].to : 0, v1 = config.points[k].to;
      CHECK(h.at(t1) == near(v1, 1e-14));
      CHECK(h.at(0.25 * t0 + 0.75 * t1) == near(0.25 * v0 + 0.75 * v1, 1e-13));
      CHECK(h.value * factor_rate(h.factor, 0.5 * (t0 + t1)) == near((v1 - v0) / (t1 - t0), 1e-12));
    }
    CHECK(h.at(1) == near(config.points.back().to, 1e-14));
    HistoryConfig mirrored = config;
    for (auto& point : mirrored.points) point.to *= -1;
    const History m = history_of(mirrored, {});
    CHECK(m.value == -h.value);
    CHECK(same_factor(m.factor, h.factor));
  }
  HistoryConfig to_the_end;
  to_the_end.points = {{1, 0.7}};
  CHECK(history_of(to_the_end, {}) == History{0.7, nullptr});
}

TEST_CASE(
    "stretched in a first stage and sheared in a second: at the kink and at the end the states of one-stage scenes") {
  const test::Solved two = solved(scene(
      "[{on: x_max, displacement: {x: [{t: 0.4, to: 0.6}, {t: 1, to: 0.6}], y: [{t: 0.4, to: 0}, {t: 1, to: 0.3}], z: 0}}]"));
  CHECK(apart(at(two, 0.4),
              solved(scene("[{on: x_max, displacement: {x: 0.6, y: 0, z: 0}}]")).last()) < 1e-8);
  CHECK(apart(two.last(),
              solved(scene("[{on: x_max, displacement: {x: 0.6, y: 0.3, z: 0}}]")).last()) < 1e-8);
}

TEST_CASE("loaded, held and unloaded: back at rest; energy balances over the kinks") {
  const std::string text = scene(
      "[{on: x_max, displacement: {x: [{t: 0.3, to: 0.6}, {t: 0.5, to: 0.6}, {t: 1, to: 0}], y: 0, z: 0}}]",
      "path: {first: 0.02, largest: 0.02}\nhomogeneous: off\n");
  const test::Solved s = solved(text);
  for (const Vec3& u : s.last().u) CHECK(u.norm() < 1e-9);
  const SolveConfig config = config_of(text);
  const Mesh mesh = mesh_in(config);
  EnergyPath path(mesh, {}, {0.3, 0.5, 1});
  StepRecord rest;
  rest.u.assign(mesh.X.size(), Vec3::Zero()), rest.reaction = rest.u;
  path.add(energy_state(rest, {}, {}));
  for (const StepRecord& step : s.steps) path.add(energy_state(step, {}, {}));
  const auto sums = path.sums();
  CHECK(sums[15].work > 0);
  for (std::size_t i = 8; i < sums.size(); ++i)
    CHECK(std::abs(sums[i].balance) < 1e-5);  // before, little work is divided by
}

TEST_CASE("symmetry asks for histories that are images, and takes them") {
  const auto symmetry = [](const std::string& loads) {
    const SolveConfig config = config_of(
        "mesh: {geometry: {block: {size: [4, 1, 2], divisions: [4, 2, 2]}}}\n"
        "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-2}}}\n"
        "supports: [{on: bottom, hold: [y, z]}]\nloads: " +
        loads + "\n");
    const Mesh mesh = mesh_in(config);
    const auto part =
        ReducedScene::find(SymmetryChoice::automatic, mesh,
                           make_scene(config, mesh, config.material, nowhere), nowhere);
    return part ? part->words().substr(0, 8) : "";
  };
  const std::string right =
      "[{on: x_max, displacement: {x: [{t: 0.5, to: 0.2}, {t: 1, to: 0.1}]}}, {on: x_min, displacement: {x: ";
  CHECK(symmetry(right + "[{t: 0.5, to: -0.2}, {t: 1, to: -0.1}]}}]") == "mirror x");
  CHECK(symmetry(right + "[{t: 0.5, to: -0.2}, {t: 1, to: -0.15}]}}]") != "mirror x");
  CHECK(symmetry(right + "[{t: 0.6, to: -0.2}, {t: 1, to: -0.1}]}}]") != "mirror x");
  CHECK(symmetry(right + "-0.2}}]") != "mirror x");
}

TEST_CASE(
    "a body that deforms alike everywhere does so with histories: one hexahedron gives the states of the mesh") {
  const std::string held =
      "supports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: z_min, hold: [z]}]\n";
  const std::string text =
      "mesh: {geometry: {block: {size: [4, 1, 2], divisions: [3, 2, 2]}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-2}}}\n" +
      held +
      "loads: [{on: x_max, displacement: {x: [{t: 0.5, to: 1}, {t: 1, to: 0.4}]}}, {on: z_max, displacement: {z: 0.2}}]\n"
      "solver: {newton: {relative: 1.0e-11}}\n";
  const SolveConfig config = config_of(text);
  const Mesh mesh = mesh_in(config);
  REQUIRE(HomogeneousScene::find(mesh, make_scene(config, mesh, config.material, nowhere), config));
  Run point(mesh, config, config.material, nowhere, true),
      whole(mesh, config, config.material, nowhere, false);
  CHECK(point.reduction.kind() == Reduction::Kind::homogeneous);
  std::vector<StepRecord> a, b;
  RunListener one, other;
  one.of_whole = [&](const StepRecord& s, const SolveReport&) {
    a.push_back(s);
  };
  other.of_whole = [&](const StepRecord& s, const SolveReport&) {
    b.push_back(s);
  };
  REQUIRE(point.follow(one).path.complete);
  REQUIRE(whole.follow(other).path.complete);
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(apart(a[i], b[i]) < 1e-7);
}

TEST_CASE(
    "a node that two keys move by different histories is refused, by the same one it is moved") {
  const auto says = [](const std::string& loads) {
    return test::said_of_scene(
        "supports: [{on: x_min, hold: [x, y, z]}]\nloads: " + loads +
            "\nmaterial: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1e-3}}}\n",
        test::cube(2));
  };
  const std::string first =
      "[{on: x_max, displacement: {x: [{t: 0.5, to: 0.2}, {t: 1, to: 0}]}}, {on: x_max, displacement: {x: ";
  CHECK(says(first + "[{t: 0.5, to: 0.2}, {t: 1, to: 0}]}}]") == "accepted");
  CHECK(says(first + "[{t: 0.4, to: 0.2}, {t: 1, to: 0}]}}]").find("by another history") !=
        std::string::npos);
  CHECK(says(first + "0.2}}]").find("loads[1].displacement") != std::string::npos);
}

TEST_CASE("a stage that the path would pass over is refused at its point") {
  const std::string block =
      "mesh: {geometry: {block: {size: [2, 1, 1], divisions: [2, 1, 1]}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-2}}}\n"
      "supports: [{on: x_min, hold: [x, y, z]}]\npath: {seconds: 1.0e+6}\nloads: [{on: x_max, displacement: {x: ";
  const auto says = [&](const std::string& history) {
    const std::string text = block + history + "}}]\n";
    return test::said_of_scene(text, test::mesh_in(test::config_of(text)));
  };
  CHECK(says("[{s: 0.01, to: 0.1}, {s: 1.0e+6, to: 0.1}]") == "accepted");
  CHECK(says("[{s: 0.0001, to: 0.1}, {s: 1.0e+6, to: 0.1}]")
            .find("loads[0].displacement.x[0]: 1e-10 of the path") != std::string::npos);
  CHECK(says("[{s: 5, to: 0.1}, {s: 5.0001, to: 0.2}, {s: 1.0e+6, to: 0.1}]")
            .find("loads[0].displacement.x[1]") != std::string::npos);
}

}  // namespace histories_tests
