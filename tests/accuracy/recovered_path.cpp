// The error bars that a config without `estimate` gets, and where it gets none.
#include "accuracy/estimate/recovered_path.hpp"
#include "accuracy/estimate/least_scatter.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "core/config/tree.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/body_mesh.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

const auto no_file = [](const std::string&) {
  return Place{};
};

SolveConfig config_from(const std::string& text) {
  return read_config<SolveConfig>(parse_yaml(text, "scene.yaml")).config;
}

struct Pressed {
  const char* x = "0";
  const char* friction = "0";
  const char* divisions = "[16, 6, 16]";
  const char* more = "";
};
SolveConfig pressed(const Pressed& p = {}) {
  return config_from(fmt::format(
      "mesh: {{geometry: {{block: {{origin: [-4, 0, -4], size: [8, 3, 8], divisions: {}}}}}}}\n"
      "material: {{matrix: {{neo_hooke: {{a1: 0.1}}}}, volume: {{quadratic: {{d: 0.01}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y, z]}}]\ncontacts: {{ball: {{rigid: {{sphere: {{radius: 3, centre: [{}, 6, 0]}}}}, "
      "friction: {}, motion: [{{t: 1, to: [0, -0.5, 0]}}]{}}}}}\npath: {{steps: 5}}\nstability: off\n",
      p.divisions, p.x, p.friction, p.more));
}

struct Told {
  bool by_default = false;
  PathErrors errors;
  std::vector<StepForces> path;
};
Told told(const SolveConfig& config) {
  Run run(body_mesh(config, "", no_file), config, config.material, no_file);
  Told out{recovered_by_default(config, run), {}, {}};
  RecoveredPath recovered(run, config, true);
  const RunEnd end = run.follow(recovered.beside({}).along(collecting({}, config, run, out.path)));
  REQUIRE(end.path.complete);
  out.errors = recovered.errors(end.last, valued(config, run.scene, run.mesh, end.last));
  return out;
}

bool has_bars(const SolveConfig& config) {
  Run run(body_mesh(config, "", no_file), config, config.material, no_file);
  return recovered_by_default(config, run);
}

}  // namespace

TEST_CASE("a config without an estimate gets a bar at every step that holds") {
  for (const char* friction : {"0", "0.4"}) {
    CAPTURE(friction);
    const SolveConfig config = pressed({"0", friction});
    const Told coarse = told(config);
    CHECK(coarse.by_default);
    SolveConfig finer = config;
    std::get<Block>(finer.mesh->geometry).divisions = {32, 12, 32};
    finer.path.use_increment(0.1);
    finer.symmetry = SymmetryChoice::automatic;
    const SolvedPath right = solved_path(finer, finer.material, no_file);
    const std::vector<double>& bars = coarse.errors.along.at("force");
    REQUIRE(bars.size() == coarse.path.size());
    for (std::size_t i = 0; i < bars.size(); ++i) {
      const double found = coarse.path[i].of.at("force"),
                   off = std::abs(found - force_at(right.path, "force", coarse.path[i].t));
      CAPTURE(coarse.path[i].t);
      CHECK(off < bars[i]);
      CHECK(bars[i] < 0.5 * found);
    }
    const ErrorEstimate& at_end = coarse.errors.at_end.front();
    CHECK(at_end.of.name == "force");
    CHECK(at_end.total() == near(bars.back()));
    CHECK((at_end.increments > 0) == has_friction(config));
    CHECK(at_end.scatter > 0);
  }
}

TEST_CASE(
    "the stress is looked at three times along a path, and what lies between is as if at every step") {
  const SolveConfig config = pressed();
  Run run(body_mesh(config, "", no_file), config, config.material, no_file);
  RecoveredPath recovered(run, config, true);
  const Body body(run.mesh, run.scene.materials, run.scene.directions, run.scene.formulation);
  std::vector<double> shares;
  std::vector<StepForces> path;
  RunListener listener;
  listener.of_whole = [&](StepRecord& whole, const SolveReport&) {
    shares.push_back(recovered_energy_share(body, whole.u));
  };
  const RunEnd end =
      run.follow(recovered.beside({}).along(collecting(listener, config, run, path)));
  const auto bars =
      recovered.errors(end.last, valued(config, run.scene, run.mesh, end.last)).along.at("force");
  REQUIRE(bars.size() == 5);
  CHECK(shares.back() == near(std::pow(recovered_error(body, end.last.u).eta, 2)));
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const double force = path[i].of.at("force"),
                 touch = 2 * 0.5 * one_by_one(path[i].touching.at("force"), false);
    // Between the three looks the share is interpolated: 38 % off at the second of five steps.
    CHECK(bars[i] / force - touch == near(shares[i], 0.4));
  }
}

TEST_CASE("where recovery was shown to tell too little a config without an estimate gets no bar") {
  CHECK(has_bars(pressed()));
  CHECK(!has_bars(pressed({"0", "0", "[16, 1, 16]"})));  // nothing is seen across one cell
  CHECK(has_bars(pressed({"0", "0", "[16, 2, 16]"})));
  CHECK(!has_bars(pressed({"0", "0", "[16, 6, 16]", ", adhesion: {work: 1.0e-3, stiffness: 3}"})));
  SolveConfig pushed = pressed();
  pushed.contacts.at("ball").motion.clear();
  pushed.contacts.at("ball").on = "top";
  pushed.contacts.at("ball").control =
      config_from(
          "mesh: {geometry: {block: {size: [1, 1, 1], divisions: [1, 1, 1]}}}\nsupports: [{on: bottom, hold: [x, y, z]}]\nmaterial: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.01}}}\n"
          "contacts: {ball: {on: top, rigid: {sphere: {radius: 3, centre: [0, 6, 0]}}, control: {force: 0.1, along: [0, -1, 0]}}}\n")
          .contacts.at("ball")
          .control;
  CHECK(!has_bars(pushed));
  SolveConfig asked = pressed();
  asked.accuracy = "1%";
  CHECK(!has_bars(asked));
  SolveConfig locks = pressed();
  locks.formulation = Formulation::displacement;
  CHECK(!has_bars(locks));
  SolveConfig long_path = pressed();
  long_path.path.seconds = 1;
  long_path.material->viscous = std::vector<ViscousBranch>{{1, 0.3}};
  CHECK(!has_bars(long_path));
  const std::string layers =
      "mesh: {geometry: {block: {size: [4, 4, 4], divisions: [4, 4, 4]}}, bodies: [{name: below, thickness: 2}, {name: above, thickness: 2}]}\n"
      "materials: {below: {material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.01}}}},\n"
      "            above: {material: {matrix: {neo_hooke: {a1: 0.4}}, volume: {quadratic: {d: 0.01}}}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\nloads: [{on: top, displacement: {y: 0.4}}]\n";
  CHECK(!has_bars(config_from(layers)));
}

TEST_CASE("cells that are longer than what touches have a warning in place of a bar") {
  const Told coarse = told(pressed({"1.3", "0", "[4, 2, 4]"}));
  CHECK(coarse.by_default);
  CHECK(coarse.errors.at_end.empty());
  CHECK(coarse.errors.along.empty());
  REQUIRE(coarse.errors.not_known.size() == 1);
  CHECK(coarse.errors.not_known[0].find("more than 15 %") != std::string::npos);
}

TEST_CASE("an indenter that is withdrawn has bars before it leaves, and one of its largest force") {
  SolveConfig config = pressed();
  auto& motion = config.contacts.at("ball").motion;
  motion.front().t = 0.6;
  motion.push_back(motion.front());
  motion.back().t = 1, motion.back().to = {0, 0.1, 0};
  const Told back = told(config);
  CHECK(back.errors.not_known.empty());
  const std::vector<double>& bars = back.errors.along.at("force");
  REQUIRE(bars.size() == back.path.size());
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const double force = back.path[i].of.at("force");
    if (force > 0) CHECK(bars[i] > 0.01 * force);
    if (force > 0) CHECK(bars[i] < 0.5 * force);
  }
  CHECK(back.path.back().of.at("force") == 0);
  // A path that ends unloaded is judged at its largest force.
  double largest = 0;
  for (const StepForces& step : back.path) largest = std::max(largest, step.of.at("force"));
  REQUIRE(back.errors.at_end.size() == 1);
  const ErrorEstimate& at_largest = back.errors.at_end[0];
  CHECK(at_largest.of.value == near(largest, 1e-12));
  CHECK(at_largest.total() > 0.01 * largest);
  CHECK(at_largest.total() < 0.5 * largest);
}

TEST_CASE("where forces alone load a body the bar is that of its stress") {
  const SolveConfig config = config_from(
      "mesh: {geometry: {block: {size: [4, 2, 2], divisions: [4, 3, 3]}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.001}}}\n"
      "supports: [{on: x_min, hold: [x, y, z]}]\nloads: [{on: x_max, force: {x: 0.2}}]\npath: {steps: 2}\nstability: off\n");
  const Told pulled = told(config);
  REQUIRE(pulled.errors.at_end.size() == 1);
  CHECK(pulled.errors.at_end[0].of.name == "von_mises_max");
  CHECK(pulled.errors.at_end[0].total() > 0.01 * pulled.errors.at_end[0].of.value);
}

TEST_CASE("a body that deforms alike everywhere has no error of its cells") {
  const SolveConfig config = config_from(
      "mesh: {geometry: {block: {size: [2, 1, 1], divisions: [3, 2, 2]}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.001}}}\n"
      "supports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: z_min, hold: [z]}]\nloads: [{on: x_max, displacement: {x: 0.6}}]\n"
      "path: {steps: 2}\n");
  Run run(body_mesh(config, "", no_file), config, config.material, no_file, true);
  CHECK(run.reduction.kind() == Reduction::Kind::homogeneous);
  CHECK(recovered_by_default(config, run));
  RecoveredPath recovered(run, config, true);
  const RunEnd end = run.follow(recovered.beside({}).along({}));
  const PathErrors errors =
      recovered.errors(end.last, valued(config, run.scene, run.mesh, end.last));
  for (const ErrorEstimate& e : errors.at_end) CHECK(e.cells == 0);
  CHECK(errors.along.at("reaction_x_max").size() == 2);
}
