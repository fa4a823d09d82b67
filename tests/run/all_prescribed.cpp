// Bodies of which every node is moved as told: nothing is to be solved, and the reactions are those
// of the law.
#include <doctest/doctest.h>

#include <cmath>

#include "scene/run/run.hpp"
#include "support/near.hpp"
#include "support/section.hpp"

using namespace langer;

TEST_CASE(
    "a body whose every node is moved has the reactions of its law: confined compression, a layer in shear") {
  const double a1 = 0.05, d = 0.01, l = 0.9;
  const std::string law =
      "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.01}}}\npath: {steps: 2}\n";
  const auto block = [](const std::string& divisions) {
    return "mesh: {geometry: {block: {size: [2, 1, 3], divisions: " + divisions + "}}}\n";
  };
  // F = diag(1, l, 1), J = l: P_yy = 2 a1 J^(-5/3) (l^2 - (l^2 + 2) / 3) + 2 (J - 1) / d
  const double P = 2 * a1 * std::pow(l, -5.0 / 3) * (l * l - (l * l + 2) / 3) + 2 * (l - 1) / d;
  for (const char* solver : {"newton", "kinsol"})
    for (const char* divisions : {"[1, 1, 1]", "[2, 1, 2]"}) {  // of four a quarter is solved
      CAPTURE(solver);
      CAPTURE(divisions);
      const SolveConfig config = test::config_of(
          block(divisions) + law +
          "supports: [{on: x_min, hold: [x]}, {on: x_max, hold: [x]}, {on: z_min, hold: [z]}, {on: z_max, hold: [z]}, {on: bottom, hold: "
          "[y]}]\nloads: [{on: top, displacement: {y: -0.1}}]\nsolver: {" +
          solver + ": {}}\n");
      Run run(test::mesh_in(config), config, config.material, test::nowhere);
      CHECK(run.body.dofs().n_free() == 0);
      const RunEnd found = run.follow();
      REQUIRE(found.path.complete);
      const test::Ended end{run.mesh, run.scene, {found.last}};
      CHECK(end.reaction("top")[1] == near(6 * P, 1e-12));
      CHECK(end.reaction("x_max")[0] == near(-end.reaction("x_min")[0], 1e-12));
    }
  // F = 1 + gamma e_x e_y, J = 1: P_xy = 2 a1 gamma
  const test::Ended sheared = test::run(
      "mesh: {geometry: {block: {size: [4, 1, 3], divisions: [4, 1, 3]}}}\n" + law +
      "supports: [{on: bottom, hold: [x, y, z]}, {on: top, hold: [y, z]}]\nloads: [{on: top, displacement: {x: 0.2}}]\n");
  CHECK(sheared.reaction("top")[0] == near(12 * 2 * a1 * 0.2, 1e-12));
  CHECK(sheared.reaction("bottom")[0] == near(-12 * 2 * a1 * 0.2, 1e-12));
}
