// An elastic body has no memory: its force follows from where the indenter is, not from how it got
// there.
#include <doctest/doctest.h>

#include "core/base/random.hpp"
#include "support/indentation.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// a quarter of the block; frictionless, cells of half a contact radius
test::Indentation quarter(CellType cells) {
  test::Indentation scene;
  scene.cells = cells, scene.quarter = true, scene.mu = 0;
  scene.nx = scene.nz = cells == CellType::tet15 ? 6 : 8, scene.ny = 2, scene.h = 0.8;
  scene.newton.relative = 1e-10;
  return scene;
}

struct Way {
  double in, deepest, out;  // force half way in, at the end, and half way out again
};

// to `depth` and half the way back, in increments of so many mm
Way way(test::Indentation scene, const Material& material, double depth, double step) {
  scene.depth = 1, scene.motion = {{2. / 3, Vec3(0, -depth, 0)}, {1, Vec3(0, -0.5 * depth, 0)}};
  scene.step = step / (1.5 * depth);
  const auto found = scene.run(material);
  REQUIRE(found.path.complete);
  Way out{0, 0, 0};
  for (const auto& s : found.steps) {
    if (std::abs(s.depth - 1. / 3) < 1e-9) out.in = s.force;
    if (std::abs(s.depth - 2. / 3) < 1e-9) out.deepest = s.force;
    if (std::abs(s.depth - 1) < 1e-9) out.out = s.force;
  }
  REQUIRE(out.in > 0);
  return out;
}

}  // namespace

TEST_CASE(
    "no memory: the same force going in and coming out, in long increments and in short ones") {
  for (CellType cells : {CellType::hex8, CellType::hex27, CellType::tet15})
    for (double c1 : {0.317, 0.0, -0.317}) {
      CAPTURE(static_cast<int>(cells));
      CAPTURE(c1);
      const Material material = test::table1(0, 1e-6, c1);
      const Way coarse = way(quarter(cells), material, 1, 0.5),
                fine = way(quarter(cells), material, 1, 0.125);
      CHECK(coarse.out == near(coarse.in, 1e-8));
      CHECK(fine.out == near(fine.in, 1e-8));
      CHECK(fine.in == near(coarse.in, 1e-8));
      CHECK(fine.deepest == near(coarse.deepest, 1e-8));
    }
}

TEST_CASE("no memory: spheres, depths, fibres and moduli drawn at random") {
  Random random(17);
  const auto draw = [&](double low, double high) {
    return low + (high - low) * random.uniform();
  };
  for (int k = 0; k < 6; ++k) {
    CAPTURE(k);
    test::Indentation scene = quarter(k % 2 == 0 ? CellType::hex27 : CellType::tet15);
    scene.radius = draw(1.5, 6), scene.h = draw(0.6, 1.1);
    const double a1 = draw(0.02, 0.5);
    Material material = test::table1(90 * (k % 3 == 1), std::pow(10, draw(-8, -2)), draw(-a1, 0.6));
    material.matrix = {Yeoh{a1, draw(0, 0.4), draw(0, 0.4)}};
    const double depth = draw(0.4, 1.1);
    const Way coarse = way(scene, material, depth, depth / 2),
              fine = way(scene, material, depth, depth / 6);
    CHECK(coarse.out == near(coarse.in, 1e-8));
    CHECK(fine.in == near(coarse.in, 1e-8));
    CHECK(fine.deepest == near(coarse.deepest, 1e-8));
  }
}

TEST_CASE(
    "no memory: KINSOL finds the state that newton finds in quadratic cells, with tangents of before too") {
  for (CellType cells : {CellType::hex27, CellType::tet15}) {
    test::Indentation scene = quarter(cells);
    scene.nx = scene.nz = 6, scene.depth = 0.5, scene.step = 0.25;
    const Material material = test::stable(0, 1e-5);
    const auto newton = scene.run(material);
    for (KinsolStrategy strategy : {KinsolStrategy::newton, KinsolStrategy::picard}) {
      CAPTURE(static_cast<int>(cells));
      CAPTURE(static_cast<int>(strategy));
      scene.kinsol = KinsolOptions{};
      scene.kinsol->strategy = strategy, scene.kinsol->relative = 1e-10;
      const auto found = scene.run(material);
      REQUIRE_MESSAGE(found.path.complete, found.path.why);
      CHECK((found.u - newton.u).lpNorm<Eigen::Infinity>() < 1e-9);
    }
  }
}
