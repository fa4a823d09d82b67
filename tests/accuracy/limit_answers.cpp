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

// A sphere with friction on a thin layer (pipelines/accuracy.yaml, isotropic t21).
const std::string scene =
    "mesh:\n"
    "  geometry: {indented_block: {origin: [-10, 0, -10], size: [20, 2.1, 20], radius: 3.85, depth: 0.31}}\n"
    "  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 2.119}}}}\n"
    "supports: [{on: bottom, hold: [x, y, z]}]\n"
    "contacts:\n"
    "  sphere:\n"
    "    on: contact\n"
    "    rigid: {sphere: {radius: 3.85, centre: [0, 5.95, 0]}}\n"
    "    friction: 0.59\n"
    "    motion: [{t: 1, to: [0, -0.31, 0]}]\n"
    "material: {matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, volume: {quadratic: {d: 1.0e-6}}}\n"
    "symmetry: auto\n"
    "stability: off\n";

// hex8 of 0.0884 contact radii in ten increments: the limit and half its bar [N]
constexpr double truth = 2.462;
constexpr double unknown = 0.01;

struct Answered {
  AccuracyLevel level;
  ErrorEstimate force;
};

// What the first level of a scene finds, as langer-solve does.
Answered first_level(const std::string& accuracy) {
  SolveConfig config = test::config_of(scene + "accuracy: " + accuracy + "\n");
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
  const Answered found = first_level("1%");
  CHECK(found.level.edge == 0.14);
  CHECK(found.force.in_percent(found.force.total()) > 1);
  CHECK(found.force.limit_answers);
  CHECK(found.force.limit_percent() <= 1);
  CHECK(std::abs(found.force.limit() - truth) < found.force.limit_bar() + unknown);
  // the value would be within its own, longer bar
  CHECK(std::abs(found.force.of.value - truth) < found.force.total() + unknown);
  CHECK(std::abs(found.force.limit() - truth) < std::abs(found.force.of.value - truth));
}

TEST_CASE("the value answers where it is asked for, on shorter cells") {
  const Answered found = first_level("{within: 1%, answer: mesh}");
  CHECK(found.level.edge == 0.11);
  CHECK(!found.force.limit_has_bar);
  CHECK(!found.force.limit_answers);
  CHECK(std::abs(found.force.of.value - truth) < found.force.total() + unknown);
}
