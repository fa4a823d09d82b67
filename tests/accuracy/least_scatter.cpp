// Lower limits of the scatter: what three meshes cannot show.
#include <doctest/doctest.h>

#include <cmath>

#include "accuracy/estimate/error_estimate.hpp"
#include "accuracy/estimate/least_scatter.hpp"
#include "scene/run/body_mesh.hpp"
#include "scene/run/step_forces.hpp"
#include "support/estimate_of.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace {

// A sphere of radius 0.547 mm pressed 0.0368 mm deep: the radius of the contact is 0.1972 mm.
std::string on_layer(double thickness, double edge = 0.14) {
  return fmt::format(
      "mesh: {{geometry: {{indented_block: {{origin: [-0.677, 0, -0.677], size: [1.354, {0:g}, 1.354], radius: 0.547, "
      "depth: 0.0368, edge: {1:g}}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y, z]}}]\n"
      "material: {{matrix: {{yeoh: {{a1: 0.112, a2: 0.056, a3: 0.0224}}}}, volume: {{quadratic: {{d: 0.00019}}}}, "
      "fibres: [{{hgo: {{c1: 0.155, c2: 1.62}}, alpha: 18.4, kappa: 0.25}}]}}\n"
      "contacts:\n"
      "  ball: {{rigid: {{sphere: {{radius: 0.547, centre: [0, {2:.10g}, 0]}}}}, motion: [{{t: 1, to: [0, -0.0368, 0]}}]}}\n"
      "path: {{first: 0.25, largest: 0.25}}\n"
      "stability: off\n"
      "estimate: refinement\n",
      thickness, edge, thickness + 0.547);
}

}  // namespace

TEST_CASE("single nodes count more on a layer that is thinner than two radii of the contact") {
  const double radius = std::sqrt(0.0368 * (2 * 0.547 - 0.0368));
  const auto factor = [&](double thickness) {
    return on_thin_layer(test::config_of(on_layer(thickness * radius)));
  };
  CHECK(factor(0.7) == 6.5);
  CHECK(factor(1) == near(6.5, 1e-5));
  CHECK(factor(1.5) == near(3.75, 1e-5));
  CHECK(factor(2.1) == 1);

  SolveConfig sheet = test::config_of(on_layer(0.7 * radius));
  sheet.supports.front().on = "x_min";
  CHECK(on_thin_layer(sheet) == 1);
  SolveConfig plane = test::config_of(on_layer(0.7 * radius));
  plane.contacts.at("ball").rigid = Plane{{0, 0.2, 0}, {0, -1, 0}};
  CHECK(on_thin_layer(plane) == 1);
}

// Three meshes agree by chance there: without the longer limit the bars of 0.11, 0.125 and 0.14
// contact radii are 0.5, 0.5 and 0.9 % long.
TEST_CASE("the bar of a force on a thin layer holds at each mesh size") {
  constexpr double right = 0.03722;  // the limit of eight meshes, 0.25 to 0.1 contact radii [N]
  constexpr double unknown = 0.0001;
  for (double edge : {0.175, 0.14, 0.125, 0.11}) {
    CAPTURE(edge);
    const SolveConfig config = test::config_of(on_layer(0.139, edge));
    Run run(body_mesh(config, "", test::nowhere), config, config.material, test::nowhere);
    std::vector<StepForces> path;
    const RunEnd end = run.follow(collecting({}, config, run, path));
    REQUIRE(end.path.complete);
    const ErrorEstimate force = test::estimate_of(
        estimated(config, config.material, test::nowhere, run, end.last, path, {}).at_end, "force");
    CHECK(std::abs(force.of.value - right) < force.total() + unknown);
    CHECK(std::abs(force.limit() - right) < force.limit_bar() + unknown);
  }
}
