// A flat punch on an elastic block, without friction: the body has no memory, so the force is one
// whatever the increments. In long increments nodes from under the face once came to lie against
// the side wall of the punch, and the force was too small by a fifth.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "mechanics/solve/edge_slip.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace {

struct Pressed {
  double force = 0;  // [N]
  int cut_backs = 0;
};

// on cells of 0.125 mm
Pressed press(const std::string& geometry, double depth, int steps) {
  const std::string text =
      "mesh:\n  geometry: " + geometry +
      "\n  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 2}}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.01}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\n"
      "contacts:\n  punch:\n    on: contact\n"
      "    rigid: {cylinder: {radius: 1.5, edge: 0.1, face: [0, 4, 0]}}\n" +
      fmt::format("    motion: [{{t: 1, to: [0, {}, 0]}}]\npath: {{steps: {}}}\n", -depth, steps);
  const SolveConfig config = test::config_of(text);
  Run run(test::mesh_in(config), config, config.material, test::nowhere);
  Pressed pressed;
  RunListener listener;
  listener.of_whole = [&](StepRecord& step, const SolveReport&) {
    pressed.force = step.force_ind.norm();
  };
  const RunEnd end = run.follow(listener);
  CAPTURE(end.path.why);
  REQUIRE(end.path.complete);
  pressed.cut_backs = end.path.cut_backs;
  MESSAGE(depth << " mm in " << steps << ": " << pressed.force << " N, " << pressed.cut_backs
                << " cut-backs, " << end.path.steps << " increments");
  return pressed;
}

const std::string section = "{section: {of: axisymmetric, size: [6, 4], divisions: [48, 16]}}";

}  // namespace

TEST_CASE("a flat punch on a section has one force, in any number of increments") {
  for (double depth : {0.3, 0.5}) {
    CAPTURE(depth);
    const Pressed reference = press(section, depth, 16);
    for (int steps : {1, 2, 3, 4, 5, 6, 8, 12}) {
      CAPTURE(steps);
      const Pressed pressed = press(section, depth, steps);
      CHECK(std::abs(pressed.force - reference.force) < 1e-6 * reference.force);
      // the surface would pass the edge
      if (steps == 1) CHECK(pressed.cut_backs > 0);
    }
  }
}

TEST_CASE(
    "a node has passed an edge where it is pressed on another side than the one it was near") {
  const RigidContact punch{"punch", Cylinder{1.5, 0.1, {0, 4, 0}}, 0, {0}, {{1, Vec3(0, -0.3, 0)}}};
  const Vec3 c0 = Vec3::Zero(), c(0, -0.3, 0);
  const auto passes = [&](const Vec3& X, const Vec3& u, const Vec3& force) {
    const std::vector<Vec3> places{X}, forces{force};
    const VecX u0 = VecX::Zero(3), moved = u;
    return node_past_edge({punch, places, u0, moved, c0, c, forces}).has_value();
  };
  const Vec3 pressed(0.1, 0, 0), under(1.3, 4, 0);
  CHECK(passes(under, Vec3(0.2, -0.05, 0), pressed));             // now at the side wall
  CHECK_FALSE(passes(under, Vec3(0.2, -0.05, 0), Vec3::Zero()));  // it bears nothing
  CHECK_FALSE(passes(under, Vec3(0, -0.3, 0), pressed));          // pressed in
  CHECK_FALSE(passes(under, Vec3(-0.4, -0.3, 0), pressed));       // and moved inwards
  CHECK_FALSE(passes({1.6, 4.5, 0}, Vec3(-0.1, 0, 0), pressed));  // at the wall all the time
}
