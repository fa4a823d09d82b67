// Candidates that the indenter cannot reach in an increment are rows like any other.
#include "mechanics/solve/candidate_levels.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "support/indentation.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

test::Indentation scene(double reach, double mu) {
  test::Indentation scene;
  scene.nx = scene.nz = 14;
  scene.ny = 2;
  scene.h = 0.45;
  scene.depth = 1;
  scene.step = 0.5;
  scene.mu = mu;
  scene.reach = reach;
  scene.newton.relative = 1e-12;
  return scene;
}

int closed(const test::Indentation::Step& step) { return step.defect.stick + step.defect.slip; }

// of an indenter and a body that differ in nothing but how they are held and which nodes may touch
void same_steps(const test::Indentation::Result& a, const test::Indentation::Result& b,
                double relative) {
  REQUIRE(a.path.complete);
  REQUIRE(b.path.complete);
  REQUIRE(a.steps.size() == b.steps.size());
  for (std::size_t i = 0; i < a.steps.size(); ++i) {
    CHECK(a.steps[i].force == near(b.steps[i].force, relative));
    CHECK(closed(a.steps[i]) == closed(b.steps[i]));
  }
}

}  // namespace

TEST_CASE("the force does not depend on nodes of the set that are never near") {
  const Material law = test::table1(30, 1e-3);
  for (double mu : {0., 0.34}) {
    CAPTURE(mu);
    const auto narrow = scene(2.6, mu).run(law);
    const auto wide = scene(6, mu).run(law);
    const auto widest = scene(20, mu).run(law);
    same_steps(wide, narrow, 1e-12);
    same_steps(widest, narrow, 1e-12);
    CHECK(widest.size.flops == wide.size.flops);  // of the last factor
  }
}

TEST_CASE("an increment that reaches further than the path of the indenter misses no contact") {
  const Material law = test::table1(30, 1e-3);
  for (double mu : {0., 0.34}) {
    CAPTURE(mu);
    // the indenter stands still: nothing is within its reach when the increment begins
    test::Indentation raised = scene(20, mu);
    raised.motion = {{1, Vec3(0, -1e-9, 0)}};
    raised.lift = 1;
    const auto lifted = raised.run(law);
    raised.contact_by = ContactBy::tangent;  // which knows no levels
    same_steps(lifted, raised.run(law), 1e-9);
    CHECK(closed(lifted.steps.back()) > 24);  // more than the first level holds
    if (mu == 0) same_steps(lifted, scene(20, mu).run(law), 1e-8);
  }
}

TEST_CASE("levels are nested, begin where the indenter comes closest and end with all candidates") {
  RigidContact sphere{"sphere", Sphere{2, {0, 2, 0}}, 0, {}, {{1, Vec3(3, -1, 0)}}};
  std::vector<Vec3> X;
  for (int i = 0; i < 21; ++i)
    for (int j = 0; j < 21; ++j) {
      sphere.nodes.push_back(static_cast<int>(X.size()));
      X.push_back(Vec3(-5 + 0.5 * i, 0, -5 + 0.5 * j));
    }
  const CandidateLevels levels({sphere}, X);
  const auto at = [&](double x, double z) {
    return levels.of(
        0, static_cast<std::size_t>(21 * std::lround(2 * (x + 5)) + std::lround(2 * (z + 5))));
  };
  CHECK(at(3, 0) == 0);         // where it goes deepest
  CHECK(at(0, 0) < at(-3, 0));  // along its path before the other side
  CHECK(at(-5, -5) == levels.all());
  CHECK(levels.holding(24) == 0);
  CHECK(levels.holding(25) == 1);
  CHECK(levels.holding(levels.size()) == levels.all());
  CHECK(levels.on_the_path(0) > 24);
  CHECK(levels.on_the_path(0) < levels.on_the_path(1));
  CHECK(levels.on_the_path(100) == levels.size());
}
