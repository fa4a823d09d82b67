// Adhesion of two deformable bodies against closed forms, and against one body on a rigid plane.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "mortar/bodies.hpp"
#include "scene/run/post_files.hpp"
#include "support/near.hpp"

using namespace langer;
using namespace langer::test;

namespace bonded_bodies_tests {

const std::string soft_material =
    "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.5}}}";

std::string body(const std::string& origin, const std::string& size, const std::string& divisions,
                 const std::string& material = soft_material) {
  return "{mesh: {geometry: {block: {origin: " + origin + ", size: " + size +
         ", divisions: " + divisions + "}}}, " + material + "}";
}

// a pad of 2 x 1 x 2 mm on a skin of the same size; nothing but bonds and supports holds either
std::string two_blocks(const std::string& pad_divisions, const std::string& supports,
                       const std::string& loads, const std::string& contact,
                       const std::string& path = "{first: 0.25, largest: 0.25}") {
  return "bodies:\n  skin: " + body("[0, 0, 0]", "[2, 1, 2]", "[4, 2, 3]") +
         "\n  pad: " + body("[0, 1, 0]", "[2, 1, 2]", pad_divisions) +
         (supports.empty() ? "\nsupports: []\n" : "\nsupports:\n" + supports) + "loads: " + loads +
         "\ncontacts: {pad: {on: pad_bottom, against: skin_top, " + contact + "}}\npath: " + path +
         "\n";
}

const std::string free_to_narrow =
    "  - {on: skin_bottom, hold: [y]}\n  - {on: skin_x_min, hold: [x]}\n"
    "  - {on: skin_z_min, hold: [z]}\n  - {on: pad_x_min, hold: [x]}\n"
    "  - {on: pad_z_min, hold: [z]}\n";

double range_of(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return (*high - *low) / std::abs(*high);
}

// The sums of langer-post over a solution.
PathSums sums_of(const BodiesScene& scene, const BodiesSolution& solution) {
  const Run run(scene.mesh, scene.config, scene.config.material, scene.where);
  EnergyPath path(scene.mesh, run.scene.contacts, {}, {}, run.scene.surfaces);
  StepRecord rest;
  rest.u.assign(scene.mesh.X.size(), Vec3::Zero());
  rest.reaction = rest.u;
  path.add(energy_state(rest, run.scene.contacts, {}, run.scene.surfaces));
  for (const StepRecord& step : solution.steps)
    path.add(energy_state(step, run.scene.contacts, {}, run.scene.surfaces));
  return path.sums().back();
}

TEST_CASE("bonds of meshes that do not match transmit a uniform tension") {
  for (const char* divisions : {"[3, 2, 5]", "[4, 2, 3]", "[7, 1, 2]"}) {
    CAPTURE(divisions);
    const BodiesScene scene = bodies_scene(two_blocks(divisions, free_to_narrow,
                                                      "[{on: pad_top, displacement: {y: 0.2}}]",
                                                      "adhesion: {work: 0.02, stiffness: 2}"));
    const BodiesSolution solution = solved(scene);
    const StepRecord& last = solution.last();
    CHECK(range_of(last.cell_fields.at("von_mises")) < 1e-9);
    CHECK(range_of(last.cell_fields.at("J")) < 1e-9);
    const std::vector<double>& gap = last.contacts.at("pad").gap;
    CHECK(range_of(gap) < 1e-9);
    // tension by undeformed area of 4 mm^2
    CHECK(last.scalars.at("force_pad_y") == near(4 * 2 * gap[0], 1e-9));
    CHECK(last.scalars.at("bonded_area") == near(4, 1e-9));
    CHECK(last.scalars.at("adhesion_stored") == near(0.5 * 4 * 2 * gap[0] * gap[0], 1e-9));
    CHECK(solution.iterations <= 5 * static_cast<int>(solution.steps.size()));
  }
}

// The gap opens on both sides alike: half of it belongs to each, with bonds that are twice as stiff
// and take half of the work.
TEST_CASE("two equal bodies that adhere are one on a plane with half the work of adhesion") {
  const std::string rest = "path: {steps: 20}\n";
  const auto skin = [](const std::string& divisions) {
    return "bodies:\n  skin: " + body("[0, 0, 0]", "[3, 1, 2]", divisions);
  };
  const std::string supports =
      "supports:\n  - {on: skin_bottom, hold: [y]}\n  - {on: skin_x_min, hold: [x]}\n"
      "  - {on: skin_z_min, hold: [z]}\n";
  const BodiesScene two = bodies_scene(
      skin("[4, 2, 3]") + "\n  pad: " + body("[0, 1, 0]", "[3, 1, 2]", "[3, 1, 2]") + "\n" + rest +
      supports +
      "  - {on: pad_x_min, hold: [x]}\n  - {on: pad_z_min, hold: [z]}\n"
      "loads: [{on: pad_top, displacement: {y: 0.3}}]\n"
      "contacts: {pad: {on: pad_bottom, against: skin_top, adhesion: {work: 0.0005, stiffness: "
      "0.05}}}\n");
  const BodiesScene one = bodies_scene(
      skin("[4, 2, 3]") + "\n" + rest + supports +
      "contacts:\n  pad: {on: skin_top, rigid: {plane: {point: [0, 1, 0], normal: [0, -1, 0]}}, "
      "motion: [{t: 1, to: [0, 0.15, 0]}], adhesion: {work: 0.00025, stiffness: 0.1}}\n");
  const BodiesSolution of_two = solved(two);
  const BodiesSolution of_one = solved(one);
  REQUIRE(of_two.steps.size() == of_one.steps.size());
  double least = 1;
  for (std::size_t i = 0; i < of_two.steps.size(); ++i) {
    const StepRecord& a = of_two.steps[i];
    const StepRecord& b = of_one.steps[i];
    CHECK(a.scalars.at("force_pad_y") == near(-b.force_ind[1], 1e-8));
    CHECK(a.scalars.at("adhesion_dissipated") ==
          near(2 * b.scalars.at("adhesion_dissipated"), 1e-7, 1e-10));
    for (double beta : a.contacts.at("pad").beta) least = std::min(least, beta);
  }
  CHECK(least < 0.5);
  CHECK(least > 0);
}

TEST_CASE("stiff bonds glue two bodies to one") {
  const std::string supports = "  - {on: skin_bottom, hold: [x, y, z]}\n";
  const auto force = [&](const std::string& stiffness) {
    return solved(bodies_scene(two_blocks("[4, 2, 3]", supports,
                                          "[{on: pad_top, displacement: {x: 0.3, y: 0.2, z: 0}}]",
                                          "friction: 0.2, adhesion: {work: 100, tangential: " +
                                              stiffness + ", stiffness: " + stiffness + "}")))
        .last()
        .scalars;
  };
  const auto soft = force("2000");
  const auto stiff = force("20000");
  // an error in proportion to the compliance of the bonds
  const auto limit = [&](const char* key) {
    return (10 * stiff.at(key) - soft.at(key)) / 9;
  };
  Vec3 whole = Vec3::Zero();
  const BodiesScene one = bodies_scene(
      "bodies:\n  skin: " + body("[0, 0, 0]", "[2, 2, 2]", "[4, 4, 3]") + "\nsupports:\n" +
      supports + "loads: [{on: skin_top, displacement: {x: 0.3, y: 0.2, z: 0}}]\n" +
      "path: {first: 0.25, largest: 0.25}\n");
  const StepRecord last = solved(one).last();
  for (int node : one.mesh.node_sets.at("skin_top"))
    whole += last.reaction[static_cast<std::size_t>(node)];
  CHECK(limit("force_pad_x") == near(whole[0], 1e-5));
  CHECK(limit("force_pad_y") == near(whole[1], 1e-5));
}

// Pulled and sheared while bonded, then turned by 40 degrees together: displacements turn as well.
TEST_CASE("bonds follow bodies that turn together") {
  const std::string bonds = "adhesion: {work: 0.1, stiffness: 1, tangential: 0.5}";
  const auto scene_of = [&](const std::string& angle, const std::string& x, const std::string& y) {
    const std::string turn = ", rotation: {angle: [{t: 0.5, to: 0}, {t: 1, to: " + angle +
                             "}], axis: [0, 0, 1], through: [1, 0, 1]}";
    return bodies_scene(
        two_blocks("[3, 2, 5]", "",
                   "\n  - {on: skin_bottom, displacement: {x: 0, y: 0, z: 0}" + turn +
                       "}\n  - {on: pad_top, displacement: {x: [{t: 0.5, "
                       "to: 0.2}, {t: 1, to: " +
                       x + "}], y: [{t: 0.5, to: 0.1}, {t: 1, to: " + y + "}], z: 0}" + turn + "}",
                   bonds, "{first: 0.05, largest: 0.05}"));
  };
  const StepRecord still = solved(scene_of("0", "0.2", "0.1")).last();
  const StepRecord turned = solved(scene_of("40", "0.0889300", "0.2051617")).last();
  CHECK(still.scalars.at("force_pad") > 0.01);
  CHECK(turned.scalars.at("force_pad") == near(still.scalars.at("force_pad"), 1e-5));
  CHECK(turned.scalars.at("adhesion_stored") == near(still.scalars.at("adhesion_stored"), 1e-5));
  CHECK(turned.scalars.at("energy") == near(still.scalars.at("energy"), 1e-5));
}

// A pad that is lifted at one side [mm].
BodiesScene peeled(const std::string& x, const std::string& friction, const std::string& path) {
  return bodies_scene(
      "bodies:\n  skin: " + body("[0, 0, 0]", "[2, 1, 1]", "[3, 1, 1]") +
      "\n  pad: " + body("[0, 1, 0]", "[2, 1, 1]", "[4, 1, 2]") +
      "\nsupports:\n  - {on: skin_bottom, hold: [x, y, z]}\n"
      "loads: [{on: pad_x_max, displacement: {x: " +
      x +
      ", y: 0.05, z: 0}}]\n"
      "contacts: {pad: {on: pad_bottom, against: skin_top, friction: " +
      friction + ", adhesion: {work: 2.0e-5, stiffness: 0.1, tangential: 0.05}}}\npath: " + path +
      "\n");
}

TEST_CASE("a pad that is peeled off keeps the balance of energy and of forces") {
  const BodiesScene scene =
      peeled("0", "0", "{first: 0.01, largest: 0.01}\nsolver: {newton: {relative: 1.0e-11}}");
  double worst_force = 0, worst_moment = 0;
  const auto each = [&](const Run&, const StepRecord& step) {
    std::vector<int> all(scene.mesh.X.size());  // supports balance each other if contact does
    std::iota(all.begin(), all.end(), 0);
    const auto [force, moment] = imbalance(scene, step, all);
    worst_force = std::max(worst_force, force);
    worst_moment = std::max(worst_moment, moment);
  };
  const BodiesSolution solution = solved(scene, each);
  const StepRecord& last = solution.last();
  CHECK(worst_force < 1e-10);
  CHECK(worst_moment < 1e-10);
  CHECK(last.scalars.at("adhesion_dissipated") > 0.5 * 2 * 2e-5);
  const PathSums sums = sums_of(scene, solution);
  CHECK(std::abs(sums.balance) < 3e-3);
  CHECK(sums.pull_off > 5e-4);
}

TEST_CASE("a run with bonds between bodies that was killed goes on with the same digits") {
  const BodiesScene scene = peeled("0.02", "0.3", "{first: 0.05, largest: 0.05}");
  const BodiesSolution whole = solved(scene);
  const std::size_t at = whole.steps.size() / 2;
  const BodiesSolution rest = solved(scene, {}, &whole.steps[at], &whole.steps[at - 1]);
  REQUIRE(rest.steps.size() == whole.steps.size() - at - 1);
  CHECK(rest.last().contacts.at("pad").beta == whole.last().contacts.at("pad").beta);
  CHECK(rest.last().scalars.at("force_pad") == whole.last().scalars.at("force_pad"));
  CHECK(rest.last().scalars.at("adhesion_dissipated") ==
        whole.last().scalars.at("adhesion_dissipated"));
}

TEST_CASE("a body that only bonds hold is pulled off by a force below the greatest") {
  const auto scene = bodies_scene(two_blocks(
      "[3, 2, 5]", "  - {on: skin_bottom, hold: [x, y, z]}\n", "[{on: pad_top, force: {y: 0.1}}]",
      "adhesion: {work: 0.003, stiffness: 0.3, tangential: 0.3}"));
  const BodiesSolution solution = solved(scene);
  CHECK(solution.last().scalars.at("force_pad_y") == near(0.1, 1e-8));
}

TEST_CASE("bonds whose gaps are wider than facets see are refused at their stiffness") {
  const BodiesScene scene = bodies_scene(two_blocks("[3, 2, 5]", free_to_narrow,
                                                    "[{on: pad_top, displacement: {y: 0.2}}]",
                                                    "adhesion: {work: 1, stiffness: 0.5}"));
  CHECK_THROWS_WITH_AS(Run(scene.mesh, scene.config, scene.config.material, scene.where),
                       doctest::Contains("contacts.pad.adhesion.stiffness"), Failure);
}

}  // namespace bonded_bodies_tests
