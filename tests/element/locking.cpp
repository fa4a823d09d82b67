// Near incompressibility: mean dilatation keeps the answer, full integration loses it.
#include <doctest/doctest.h>

#include "support/indentation.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

void keeps_its_force(const test::Indentation& scene, double alpha, const std::vector<double>& ds,
                     double tolerance) {
  const auto reference = scene.run(test::table1(alpha, 1e-6));
  REQUIRE(reference.path.complete);
  for (double d : ds) {
    const auto result = scene.run(test::table1(alpha, d));
    CAPTURE(d);
    REQUIRE(result.path.complete);
    CHECK(result.steps.back().force == near(reference.steps.back().force, tolerance));
    CHECK(result.path.iterations <= reference.path.iterations + 3);
    CHECK(result.n_indefinite == 0);
  }
}

}  // namespace

TEST_CASE(
    "mean dilatation: the force of an indentation stays within 2 % from d = 1e-2 to 1e-9, at the same cost") {
  test::Indentation scene;
  scene.nx = scene.nz = 14, scene.ny = 4, scene.h = 0.45, scene.depth = 0.6, scene.step = 0.2;
  keeps_its_force(scene, 60, {1e-2, 1e-3, 1e-4, 1e-7, 1e-8, 1e-9}, 0.02);
}

TEST_CASE(
    "hex27 with linear dilatation: the force of an indentation stays within 0.5 % from d = 1e-4 to 1e-9, at the same cost") {
  test::Indentation scene;
  scene.cells = CellType::hex27, scene.quarter = true;
  scene.nx = scene.nz = 10, scene.ny = 2, scene.h = 0.7, scene.depth = 0.4, scene.step = 0.2;
  keeps_its_force(scene, 0, {1e-4, 1e-7, 1e-9}, 0.005);
}

TEST_CASE(
    "tet15: the force of an indentation stays within 0.5 % from d = 1e-4 to 1e-9, at the same cost") {
  test::Indentation scene;
  scene.cells = CellType::tet15, scene.quarter = true;
  scene.nx = scene.nz = 8, scene.ny = 2, scene.h = 0.9, scene.depth = 0.4, scene.step = 0.2;
  keeps_its_force(scene, 0, {1e-4, 1e-7, 1e-9}, 0.005);
}

TEST_CASE("full integration locks: the force grows many times as d falls") {
  test::Indentation scene;
  scene.nx = scene.nz = 14, scene.ny = 4, scene.h = 0.45, scene.depth = 0.2, scene.step = 0.05;
  const auto right = scene.run(test::table1(60, 1e-3));
  scene.formulation = Formulation::displacement;
  double last = right.steps.back().force;
  for (double d : {1e-2, 1e-3}) {
    const auto locked = scene.run(test::table1(60, d));
    CAPTURE(d);
    REQUIRE(!locked.steps.empty());
    const double ratio = locked.steps.back().force / right.steps.back().force;
    MESSAGE("d " << d << ": " << ratio << " times the force, at " << locked.steps.back().depth
                 << " mm");
    CHECK(locked.steps.back().force > 1.3 * last);
    last = locked.steps.back().force;
  }
}
