// Contact in the tangent itself finds what contact condensed to its candidates finds.
#include "mechanics/solve/contact_in_tangent.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include <fmt/format.h>

#include "scene/run/body_mesh.hpp"
#include "support/indentation.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace {

test::Indentation small(double mu) {
  test::Indentation scene;
  scene.nx = scene.nz = 8, scene.ny = 2, scene.h = 0.7, scene.depth = 0.4, scene.step = 0.2,
  scene.mu = mu;
  scene.newton.relative = 1e-11;
  return scene;
}

void compare(test::Indentation scene, const Material& law) {
  scene.contact_by = ContactBy::compliance;
  const auto condensed = scene.run(law);
  scene.contact_by = ContactBy::tangent;
  bool in_tangent = true;
  scene.after = [&](const Increment& increment, const Assembler&) {
    in_tangent = in_tangent && increment.contact_in_tangent();
  };
  const auto sparse = scene.run(law);
  REQUIRE(condensed.path.complete);
  CAPTURE(sparse.path.why);
  REQUIRE(sparse.path.complete);
  CHECK(in_tangent);
  REQUIRE(condensed.steps.size() == sparse.steps.size());
  for (std::size_t i = 0; i < sparse.steps.size(); ++i) {
    const auto &a = condensed.steps[i], &b = sparse.steps[i];
    CHECK(b.force == near(a.force, 1e-8));
    CHECK((b.defect.force - a.defect.force).norm() <= 1e-8 * a.defect.force.norm());
    CHECK(b.defect.penetration <= 1e-9);
    CHECK(b.defect.cone <= 1e-9);
    CHECK(b.defect.complementarity <= 1e-9);
    CHECK(b.defect.stick + b.defect.slip == a.defect.stick + a.defect.slip);
    CHECK(b.defect.stick == a.defect.stick);
  }
  CHECK((condensed.u - sparse.u).lpNorm<Eigen::Infinity>() < 1e-8);
  CHECK(sparse.n_indefinite <=
        condensed.n_indefinite);  // what gives way without contact may be stable with it
}

}  // namespace

TEST_CASE(
    "contact in the tangent: a sphere with and without friction, whole and a quarter whose planes hold candidates") {
  for (double mu : {0.0, 0.1, 0.34, 1.0})
    for (bool quarter : {false, true}) {
      const double friction = mu;
      CAPTURE(friction);
      CAPTURE(quarter);
      auto scene = small(mu);
      scene.quarter = quarter;
      compare(scene, test::table1(30, 1e-4));
    }
}

TEST_CASE(
    "contact in the tangent: a plane on all candidates, a sphere that scratches, one that is taken back") {
  for (double mu : {0.0, 0.3}) {
    const double friction = mu;
    CAPTURE(friction);
    auto plane = small(mu);
    plane.shape = Plane{{0, 4, 0}, {0, -1, 0}}, plane.reach = 30, plane.depth = 0.2,
    plane.step = 0.1;
    compare(plane, test::neo_hooke(0.3, 1e-4));
    auto scratch = small(mu);
    scratch.motion = {{0.5, Vec3(0, -0.3, 0)}, {1, Vec3(0.4, -0.3, 0.1)}};
    compare(scratch, test::table1(30, 1e-3));
    auto back = small(mu);
    back.motion = {{0.5, Vec3(0, -0.4, 0)}, {1, Vec3(0, -0.2, 0)}};
    compare(back, test::neo_hooke(0.3, 1e-3));
  }
}

TEST_CASE(
    "contact in the tangent: many candidates with friction stay condensed on a deep body, where a factorization costs more") {
  for (int layers : {2, 24})
    for (double mu : {0.0, 0.3}) {
      CAPTURE(layers);
      const double friction = mu;
      CAPTURE(friction);
      test::Indentation scene;
      scene.nx = scene.nz = 20, scene.ny = layers, scene.h = 0, scene.depth = 1e-3,
      scene.step = 1e-3, scene.mu = mu;
      bool in_tangent = false;
      scene.after = [&](const Increment& increment, const Assembler&) {
        in_tangent = increment.contact_in_tangent();
      };
      scene.shape = Plane{{0, 4, 0}, {0, -1, 0}}, scene.reach = 30;
      REQUIRE(scene.run(test::neo_hooke(0.3, 1e-4)).path.complete);
      CHECK(in_tangent == (mu == 0 || layers == 2));
    }
}

// What a sphere presses hard is not stable without it: its tangent is not positive definite there,
// on fine cells more so.
TEST_CASE(
    "contact in the tangent: a sphere with friction on a fine section needs no shorter steps") {
  const auto pressed = [](double edge) {
    const SolveConfig config = test::config_of(fmt::format(
        "mesh: {{geometry: {{indented_disc: {{size: [16.9, 4], radius: 2.5, depth: 1, edge: {}}}}}}}\n"
        "supports: [{{on: bottom, hold: [x, y]}}]\n"
        "material: {{matrix: {{yeoh: {{a1: 0.269, a2: 0.376, a3: 0.415}}}}, volume: {{quadratic: {{d: 1.0e-6}}}}}}\n"
        "contacts: {{ball: {{rigid: {{sphere: {{radius: 2.5, centre: [0, 6.5, 0]}}}}, friction: 0.34, motion: [{{t: 1, to: [0, -1, 0]}}]}}}}\n"
        "stability: off\n",
        edge));
    Run run(body_mesh(config, "", test::nowhere), config, config.material, test::nowhere);
    RunEnd end = run.follow();
    CHECK(end.path.complete);
    CHECK(end.path.steps == 10);
    CHECK(end.path.cut_backs == 0);
    return std::pair(end.last.force_ind.norm(), run.increment.contact_in_tangent());
  };
  const double coarse = pressed(0.04).first;
  const auto [fine, sparse] = pressed(0.02);
  CHECK(sparse);
  CHECK(fine == near(coarse, 2e-3));
}
