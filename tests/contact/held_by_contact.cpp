// Bodies that are not held, or not stable, without their contacts: exact law, quadratic
// convergence, no shift left behind.
#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/contact/supported_problem.hpp"
#include "support/directions.hpp"
#include "support/exact_run.hpp"
#include "support/indentation.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;
using test::ExactPath;
using test::run;

TEST_CASE("a cube between two rough plates, held by nothing else") {
  const Mesh mesh = test::cube(4);
  Assembler body = test::equilibrium(mesh, {test::stable(30, 1e-4)}, Formulation::mean_dilatation,
                                     number_dofs(mesh.n_nodes(), {}).dofs);
  const RigidContact below{
      "below", Plane{{0, 0, 0}, {0, 1, 0}}, 0.5, mesh.node_sets.at("y_min"), {{1, Vec3(0, 0, 0)}}};
  const RigidContact above{"above",
                           Plane{{0, 1, 0}, {0, -1, 0}},
                           0.5,
                           mesh.node_sets.at("y_max"),
                           {{1, Vec3(0, -0.2, 0)}}};
  Increment increment(body, {below, above}, {});
  const ExactPath result = run(increment, 0.1);
  REQUIRE(result.path.complete);
  CHECK(result.path.cut_backs == 0);
  for (int n : result.iterations) CHECK(n <= 7);
  const auto defects = increment.defects();
  CHECK(defects[0].force[1] > 0.01);
  CHECK((defects[0].force + defects[1].force).norm() < 1e-7 * defects[0].force[1]);
  CHECK(increment.n_indefinite() > 0);
  CHECK(increment.n_unstable() == 0);
}

TEST_CASE("the same cube on a held base gives the same force: the springs leave nothing behind") {
  const Mesh mesh = test::cube(4);
  const RigidContact above{"above",
                           Plane{{0, 1, 0}, {0, -1, 0}},
                           5,
                           mesh.node_sets.at("y_max"),
                           {{1, Vec3(0, -0.1, 0)}}};
  const auto force = [&](bool glued) {
    std::vector<Prescribed> held;
    std::vector<RigidContact> contacts{above};
    if (glued)
      for (int i : mesh.node_sets.at("y_min"))
        for (int k = 0; k < 3; ++k) held.push_back({3 * i + k, 0});
    else  // mu = 5 sticks everywhere: as good as glued
      contacts.push_back({"below",
                          Plane{{0, 0, 0}, {0, 1, 0}},
                          5,
                          mesh.node_sets.at("y_min"),
                          {{1, Vec3(0, 0, 0)}}});
    Assembler body = test::equilibrium(mesh, {test::stable(30, 1e-4)}, Formulation::mean_dilatation,
                                       number_dofs(mesh.n_nodes(), held).dofs);
    Increment increment(body, contacts, {});
    REQUIRE(run(increment, 0.25).path.complete);
    return -increment.defects()[0].force[1];
  };
  CHECK(force(false) == near(force(true), 1e-7));
}

TEST_CASE("a block that may glide along x is held by the rough sphere that presses it") {
  test::Indentation scene;
  scene.nx = scene.nz = 10, scene.ny = 3, scene.h = 0.6, scene.depth = 0.5, scene.loose_base = true;
  const auto result = scene.run(test::stable(60, 1e-5));
  REQUIRE(result.path.complete);
  CHECK(result.n_indefinite > 0);
  for (const auto& step : result.steps) {
    CHECK(step.iterations <= 9);
    CHECK(step.defect.penetration <= 1e-9);
    CHECK(step.defect.complementarity <= 1e-8);
  }
  CHECK(result.steps.back().force > 0.1);
}

TEST_CASE(
    "deep indentation goes on where friction alone keeps the contact stable, three to five iterations a step") {
  test::Indentation scene;
  scene.nx = scene.nz = 14, scene.ny = 4, scene.h = 0.45, scene.depth = 1.8, scene.reach = 4;
  const auto result = scene.run(test::table1(0, 1e-6, 0));
  REQUIRE(result.path.complete);
  CHECK(result.path.cut_backs == 0);
  for (const auto& step : result.steps) {
    CHECK(step.iterations <= 5);
    CHECK(step.defect.penetration <= 1e-9);
    CHECK(step.defect.complementarity <= 1e-8);
  }
}
