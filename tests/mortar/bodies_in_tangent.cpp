// Contact of bodies in the tangent against the same scenes with contact condensed.
#include "mechanics/solve/bodies_in_tangent.hpp"

#include <doctest/doctest.h>

#include "mortar/bodies.hpp"
#include "support/near.hpp"

using namespace langer;
using namespace langer::test;

namespace {

struct Solved {
  std::vector<StepRecord> steps;
  int iterations = 0;
  long factorizations = 0;
};

Solved solved_by(const BodiesScene& scene, ContactBy by) {
  IncrementOptions options;
  options.contact_by = by;
  options.law_tolerance = 1e-13;
  Run run(scene.mesh, make_scene(scene.config, scene.mesh, scene.config.material, scene.where),
          std::nullopt, scene.config.path, scene.config.solver, options);
  CHECK(run.increment.bodies_in_tangent() == (by == ContactBy::tangent));
  Solved out;
  RunListener listener;
  listener.of_whole = [&](const StepRecord& step, const SolveReport& report) {
    out.steps.push_back(step);
    out.iterations += report.iterations;
  };
  CHECK(run.follow(listener).at == RunEnd::At::the_end);
  CHECK(run.increment.bodies_in_tangent() == (by == ContactBy::tangent));
  out.factorizations = run.increment.cost().factorizations;
  return out;
}

void check_both(const std::string& text, double tolerance) {
  const BodiesScene scene = bodies_scene(text);
  const Solved condensed = solved_by(scene, ContactBy::compliance);
  const Solved in_tangent = solved_by(scene, ContactBy::tangent);
  REQUIRE(condensed.steps.size() == in_tangent.steps.size());
  double largest = 0;
  double apart = 0;
  for (std::size_t i = 0; i < condensed.steps.size(); ++i)
    for (std::size_t n = 0; n < condensed.steps[i].u.size(); ++n) {
      largest = std::max(largest, condensed.steps[i].u[n].norm());
      apart = std::max(apart, (condensed.steps[i].u[n] - in_tangent.steps[i].u[n]).norm());
    }
  CHECK(apart < tolerance * largest);
  MESSAGE("apart " << apart / largest << ", iterations " << condensed.iterations << ", "
                   << in_tangent.iterations << ", factorizations " << condensed.factorizations
                   << ", " << in_tangent.factorizations);
}

std::string blocks(const std::string& low, const std::string& up, const std::string& supports,
                   const std::string& move, const std::string& friction,
                   const std::string& path = "{first: 0.5, largest: 0.5}") {
  return "bodies:\n"
         "  low:\n"
         "    mesh: {geometry: {block: " +
         low +
         "}}\n"
         "    material: {matrix: {neo_hooke: {a1: 0.02}}, volume: {quadratic: {d: 0.1}}}\n"
         "  up:\n"
         "    mesh: {geometry: {block: " +
         up +
         "}}\n"
         "    material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.05}}}\n"
         "supports:\n  - {on: low_bottom, hold: [x, y, z]}\n" +
         supports + "loads:\n  - {on: up_top, displacement: " + move +
         "}\n"
         "contacts: {c: {on: up_bottom, against: low_top, friction: " +
         friction + "}}\npath: " + path + "\n";
}

}  // namespace

TEST_CASE("bodies in the tangent: a block that is pressed and drawn over another one") {
  const std::string low = "{origin: [0, 0, 0], size: [4, 1.5, 4], divisions: [6, 3, 5]}";
  const std::string same = "{origin: [0, 1.5, 0], size: [4, 1, 4], divisions: [5, 2, 7]}";
  const std::string smaller = "{origin: [1.1, 1.5, 0.9], size: [2, 1, 2], divisions: [4, 2, 3]}";
  for (const std::string& up : {same, smaller})
    for (const std::string friction : {"0", "0.3", "2"}) {
      const auto shown = up + friction;
      CAPTURE(shown);
      check_both(blocks(low, up, "", "{x: 0.25, y: -0.2, z: 0.1}", friction), 1e-8);
    }
}

TEST_CASE("bodies in the tangent: a quarter of two blocks, with friction") {
  check_both(blocks("{origin: [0, 0, 0], size: [4, 1.5, 4], divisions: [6, 3, 5]}",
                    "{origin: [0, 1.5, 0], size: [3, 1, 3], divisions: [5, 2, 4]}",
                    "  - {on: low_x_min, hold: [x]}\n  - {on: low_z_min, hold: [z]}\n"
                    "  - {on: up_x_min, hold: [x]}\n  - {on: up_z_min, hold: [z]}\n",
                    "{y: -0.3}", "0.3"),
             1e-8);
}

TEST_CASE("bodies in the tangent: a run that was killed goes on with the same digits") {
  const BodiesScene scene =
      bodies_scene(blocks("{origin: [0, 0, 0], size: [6, 1, 6], divisions: [11, 1, 11]}",
                          "{origin: [0.6, 1, 0.7], size: [4, 1, 4], divisions: [10, 1, 10]}", "",
                          "{x: 0.6, y: -0.2, z: 0.1}", "0.3", "{first: 0.25, largest: 0.25}"));
  const BodiesSolution whole = solved(
      scene, [](const Run& run, const StepRecord&) { CHECK(run.increment.bodies_in_tangent()); });
  const BodiesSolution rest = solved(scene, {}, &whole.steps[1], &whole.steps[0]);
  REQUIRE(rest.steps.size() == 2);
  CHECK(rest.last().u == whole.last().u);
}
