// The limit of the meshes as the answer to an accuracy, against a much finer solution.
#include <doctest/doctest.h>

#include <cmath>

#include "accuracy/estimate/error_estimate.hpp"
#include "accuracy/refinement/accuracy.hpp"
#include "scene/run/body_mesh.hpp"
#include "scene/run/step_forces.hpp"
#include "support/estimate_of.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace {

// A sphere with friction on skin with one family of fibres.
const std::string scene =
    "mesh:\n"
    "  geometry: {indented_block: {origin: [-15, 0, -15], size: [30, 4, 30], radius: 2.5, depth: 1, edge: 0.11}}\n"
    "  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 3.4}}}}\n"
    "supports: [{on: bottom, hold: [x, y, z]}]\n"
    "contacts:\n"
    "  sphere:\n"
    "    on: contact\n"
    "    rigid: {sphere: {radius: 2.5, centre: [0, 6.5, 0]}}\n"
    "    friction: 0.34\n"
    "    motion: [{t: 1, to: [0, -0.8, 0]}]\n"
    "material:\n"
    "  matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}\n"
    "  fibres: [{hgo: {c1: 0.3, c2: 0.8}, alpha: 30}]\n"
    "  volume: {quadratic: {d: 1.0e-3}}\n"
    "path: {first: 0.25, largest: 0.25}\n"
    "symmetry: auto\n"
    "stability: off\n";

// langer-solve with accuracy: 0.45 %, whose bar is 0.37 % [N]
constexpr double truth = 7.408;
constexpr double unknown = 0.028;

struct Answered {
  AccuracyLevel level;
  ErrorEstimate force;
};

// What the first level of a scene finds, as langer-solve does.
Answered first_level(const std::string& text) {
  SolveConfig config = test::config_of(text);
  const ChosenLevel chosen = *choose_accuracy(config, config.material, true);
  Run run(body_mesh(config, "", test::nowhere), config, config.material, test::nowhere);
  std::vector<StepForces> path;
  const RunEnd end = run.follow(collecting({}, config, run, path));
  REQUIRE(end.path.complete);
  std::vector<ErrorEstimate> errors =
      estimated(config, config.material, test::nowhere, run, end.last, path, {}).at_end;
  const Accuracy judge({"solve", true}, config, config.material, test::nowhere, false);
  judge.name_answers(errors);
  return {chosen.level, test::estimate_of(errors, "force")};
}

}  // namespace

TEST_CASE("a scene with friction is answered by the limit of its meshes, within its bar") {
  const Answered found = first_level(scene + "accuracy: 0.85%\n");
  CHECK(found.force.in_percent(found.force.total()) > 0.85);
  CHECK(found.force.limit_answers);
  CHECK(found.force.limit_percent() <= 0.85);
  CHECK(std::abs(found.force.limit() - truth) < found.force.limit_bar() + unknown);
  // the value would be within its own, longer bar
  CHECK(std::abs(found.force.of.value - truth) < found.force.total() + unknown);
}

TEST_CASE("the value answers where it is asked for, on shorter cells") {
  const Answered found = first_level(scene + "accuracy: {within: 1%, answer: mesh}\n");
  CHECK(!found.force.limit_has_bar);
  CHECK(!found.force.limit_answers);
  CHECK(std::abs(found.force.of.value - truth) < found.force.total() + unknown);
  const auto edge_of = [](const std::string& accuracy) {
    SolveConfig config = test::config_of(scene + "accuracy: " + accuracy + "\n");
    std::get<IndentedBlock>(config.mesh->geometry).edge = 0.175;
    return choose_accuracy(config, config.material, true)->level.edge;
  };
  CHECK(edge_of("1%") == 0.14);
  CHECK(edge_of("{within: 1%, answer: mesh}") == 0.11);
}

// Without friction the value of a coarse mesh may be right by far more than its bar, and the fit of
// three meshes then only adds what single nodes make of the forces.
TEST_CASE("the limit of a smooth scene is within its bar, and answers only where that is shorter") {
  const std::string smooth =
      "mesh: {geometry: {indented_block: {origin: [-6, 0, -6], size: [12, 4, 12], radius: 2.5, depth: 0.8}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\n"
      "contacts: {sphere: {rigid: {sphere: {radius: 2.5, centre: [0, 6.5, 0]}}, motion: [{t: 1, to: [0, -0.8, 0]}]}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1.0e-2}}}\n"
      "path: {first: 0.25, largest: 0.25}\n"
      "stability: off\n"
      "accuracy: 0.8%\n";
  constexpr double right = 1.7405;  // hex27 of 0.13 and 0.11, hex8 of 0.07 contact radii [N]
  constexpr double not_known = 0.002;
  const Answered found = first_level(smooth);
  CHECK(std::abs(found.force.limit() - right) < found.force.limit_bar() + not_known);
  CHECK(std::abs(found.force.of.value - right) < found.force.total() + not_known);
  CHECK((!found.force.limit_answers || found.force.limit_bar() < found.force.total()));
}
