// Paths with arc lengths through contact: the load factor is a result, also where an indenter is
// pushed or moved, and where deformable surfaces touch. Compared with the same equilibria found at
// given loads, which do not depend on the path where nothing rubs.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mortar/bodies.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;
using namespace langer::test;

namespace arc_with_contact_tests {

namespace {

struct Path {
  std::vector<StepRecord> steps;
  bool complete = false;
  std::string why;

  std::vector<double> history(const std::string& name) const {
    std::vector<double> values;
    for (const StepRecord& step : steps) values.push_back(step.scalars.at(name));
    return values;
  }
  std::vector<double> force() const {  // on the indenter, along y [N]
    std::vector<double> values;
    for (const StepRecord& step : steps) values.push_back(step.force_ind[1]);
    return values;
  }
};

Path followed(Run& run, const std::vector<StepRecord>& from = {}) {
  if (!from.empty()) {
    run.resume(from.back(), from.size() > 1 ? std::optional(from[from.size() - 2]) : std::nullopt);
    run.resume_all();
  }
  Path path;
  RunListener listener;
  listener.of_whole = [&](const StepRecord& step, const SolveReport&) {
    path.steps.push_back(step);
  };
  const RunEnd end = run.follow(listener);
  path.complete = end.path.complete;
  path.why = end.path.why;
  return path;
}

Path followed(const std::string& text, const std::vector<StepRecord>& from = {}) {
  const SolveConfig config = config_of(text);
  Run run(mesh_in(config), config, config.material, nowhere);
  return followed(run, from);
}

Path followed(const BodiesScene& scene) {
  Run run(scene.mesh, scene.config, scene.config.material, scene.where);
  return followed(run);
}

// A clamped arch, pressed down at its top by a sphere. Its force has a greatest and a least value.
std::string arch(double friction, const std::string& driven, const std::string& path) {
  return fmt::format(
      "mesh: {{geometry: {{block: {{origin: [-20, 0, 0], size: [40, 1, 1], divisions: [20, 1, 1]}}}}, bend: 50, cells: hex27}}\n"
      "supports: [{{on: x_max, hold: [x, y, z]}}, {{on: x_min, hold: [x, y, z]}}]\n"
      "material: {{matrix: {{neo_hooke: {{a1: 0.1666666667}}}}, volume: {{quadratic: {{d: 1.0e-2}}}}}}\n"
      "contacts: {{tip: {{on: top, friction: {}, rigid: {{sphere: {{centre: [0, 4, 0.5], radius: 3}}}}, {}}}}}\n"
      "estimate: none\nstability: off\npath: {}\n",
      friction, driven, path);
}
std::string moved_by(double way) {
  return fmt::format("motion: [{{t: 1, to: [0, {:.17g}, 0]}}]", way);
}
const std::string pushed = "control: {along: [0, -1, 0], force: 0.1}";
const std::string in_arcs = "{first: 0.02, largest: 0.03, arc_length: {length: 10}}";
const std::string at_once = "{first: 0.05, largest: 0.05}";

int turns_of(const std::vector<double>& values) {
  int turns = 0;
  for (std::size_t i = 1; i + 1 < values.size(); ++i)
    turns += (values[i + 1] - values[i]) * (values[i] - values[i - 1]) < 0;
  return turns;
}

}  // namespace

TEST_CASE("arc and contact: an arch that is pushed passes both of its limit points") {
  for (const double friction : {0.0, 0.4}) {
    CAPTURE(friction);
    const Path by_force = followed(arch(friction, pushed, in_arcs));
    const Path by_way = followed(arch(friction, moved_by(-9), in_arcs));
    CAPTURE(by_force.why);
    REQUIRE(by_force.complete);
    REQUIRE(by_way.complete);
    CHECK(turns_of(by_force.history("load_factor")) == 2);
    CHECK(turns_of(by_way.history("load_factor")) == 0);  // the way itself does not turn back
    // the same increments, whether the force or the way is in proportion to the load factor
    REQUIRE(by_force.steps.size() == by_way.steps.size());
    const double largest = by_force.force().back();
    for (std::size_t i = 0; i < by_force.steps.size(); ++i) {
      CHECK(by_force.force()[i] == near(by_way.force()[i], 0, 1e-9 * largest));
      CHECK((by_force.steps[i].u_ind - by_way.steps[i].u_ind).norm() < 1e-8);
      CHECK(by_force.force()[i] == near(0.1 * load_factor_of(by_force.steps[i]), 1e-8));
    }
  }
}

TEST_CASE("arc and contact: without friction the force is that of an indenter at the same place") {
  const Path arcs = followed(arch(0, pushed, in_arcs));
  REQUIRE(arcs.complete);
  for (const std::size_t i : {arcs.steps.size() / 3, arcs.steps.size() - 1}) {
    const Path way = followed(arch(0, moved_by(arcs.steps[i].u_ind[1]), at_once));
    CAPTURE(way.why);
    REQUIRE(way.complete);
    CHECK(way.force().back() == near(arcs.force()[i], 1e-8));
  }
}

TEST_CASE("arc and contact: a path goes on with the same digits after a kill") {
  const Path whole = followed(arch(0.4, pushed, in_arcs));
  REQUIRE(whole.complete);
  const std::size_t half = whole.steps.size() / 2;
  const Path rest =
      followed(arch(0.4, pushed, in_arcs), {whole.steps.begin(), whole.steps.begin() + half});
  REQUIRE(rest.complete);
  REQUIRE(rest.steps.size() == whole.steps.size() - half);
  CHECK(rest.steps.back().u == whole.steps.back().u);
  CHECK(load_factor_of(rest.steps.back()) == load_factor_of(whole.steps.back()));
}

TEST_CASE("arc and contact: a cap that snaps lands on a floor, with friction too") {
  for (const double friction : {0.0, 0.3}) {
    CAPTURE(friction);
    const Path path = followed(fmt::format(
        "mesh: {{geometry: {{section: {{of: axisymmetric, size: [20, 1], divisions: [16, 1]}}}}, bend: 100, cells: hex27}}\n"
        "supports: [{{on: x_max, hold: [x, y]}}]\n"
        "loads: [{{on: top, pressure: 1.0e-4}}]\n"
        "material: {{matrix: {{neo_hooke: {{a1: 0.1666666667}}}}, volume: {{quadratic: {{d: 1.0e-2}}}}}}\n"
        "contacts: {{floor: {{on: bottom, friction: {}, rigid: {{plane: {{point: [0, -2.5, 0], normal: [0, 1, 0]}}}}, motion: [{{t: 1, to: [0, 0, 0]}}]}}}}\n"
        "estimate: none\nstability: off\npath: {{first: 0.03, largest: 0.05, arc_length: {{length: 2.4}}}}\n",
        friction));
    CAPTURE(path.why);
    REQUIRE(path.complete);
    CHECK(turns_of(path.history("load_factor")) == 2);
    CHECK(path.steps.back().force_ind[1] < 0);
    CHECK(path.steps.back().scalars.at("penetration") < 1e-9);
  }
}

TEST_CASE("arc and contact: a pushed indenter and a traction grow together") {
  const auto scene = [](double factor, const std::string& path) {
    return fmt::format(
        "mesh: {{geometry: {{block: {{origin: [-3, 0, -3], size: [6, 3, 6], divisions: [6, 3, 6]}}}}}}\n"
        "supports: [{{on: bottom, hold: [x, y, z]}}]\n"
        "loads: [{{on: x_max, traction: {{x: {:.17g}}}}}]\n"
        "material: {{matrix: {{neo_hooke: {{a1: 0.01}}}}, volume: {{quadratic: {{d: 1.0e-1}}}}}}\n"
        "contacts: {{tip: {{on: top, rigid: {{sphere: {{centre: [0, 5, 0], radius: 2}}}}, control: {{along: [0, -1, 0], force: {:.17g}}}}}}}\n"
        "estimate: none\npath: {}\n",
        0.002 * factor, 0.2 * factor, path);
  };
  const Path arcs = followed(scene(1, "{first: 0.1, largest: 0.2, arc_length: {length: 0.5}}"));
  CAPTURE(arcs.why);
  REQUIRE(arcs.complete);
  const double factor = load_factor_of(arcs.steps.back());
  CHECK(factor > 0.1);
  const Path given = followed(scene(factor, "{first: 0.1, largest: 0.2}"));
  REQUIRE(given.complete);
  CHECK(largest_difference(arcs.steps.back().u, given.steps.back().u) < 1e-10);
}

TEST_CASE("arc and contact: deformable surfaces that touch, in a section of two bodies") {
  const auto scene = [](double factor, const std::string& path) {
    return bodies_scene(fmt::format(
        "bodies:\n"
        "  tissue:\n"
        "    mesh: {{geometry: {{block: {{origin: [0, 0, 0], size: [12, 4, 2], divisions: [6, 2, 1]}}}}}}\n"
        "    material: {{matrix: {{yeoh: {{a1: 0.008, a2: 0.01, a3: 0.005}}}}, volume: {{quadratic: {{d: 1.0e-3}}}}}}\n"
        "  liner:\n"
        "    mesh: {{geometry: {{block: {{origin: [3, 4, 0], size: [6, 2, 2], divisions: [5, 2, 1]}}}}}}\n"
        "    material: {{matrix: {{neo_hooke: {{a1: 0.05}}}}, volume: {{quadratic: {{d: 1.0e-3}}}}}}\n"
        "supports:\n"
        "  - {{on: tissue_bottom, hold: [x, y, z]}}\n"
        "  - {{on: tissue_z_min, hold: [z]}}\n  - {{on: tissue_z_max, hold: [z]}}\n"
        "  - {{on: liner_z_min, hold: [z]}}\n  - {{on: liner_z_max, hold: [z]}}\n"
        "loads: [{{on: liner_top, displacement: {{x: {:.17g}, y: {:.17g}}}}}]\n"
        "contacts: {{liner: {{on: liner_bottom, against: tissue_top}}}}\n"
        "path: {}\n",
        0.3 * factor, -0.8 * factor, path));
  };
  const Path arcs = followed(scene(1, "{first: 0.05, largest: 0.1, arc_length: {length: 0.5}}"));
  CAPTURE(arcs.why);
  REQUIRE(arcs.complete);
  const double factor = load_factor_of(arcs.steps.back());
  CHECK(factor > 0.1);
  const Path given = followed(scene(factor, "{first: 0.05, largest: 0.1}"));
  REQUIRE(given.complete);
  CHECK(largest_difference(arcs.steps.back().u, given.steps.back().u) < 1e-10);
}

// The nodes of the contact set that are clamped have no compliance. They once made the tolerance of
// the contact law infinite where the body is stable through its contact only, and the path ended at
// the greatest force.
TEST_CASE(
    "arc and contact: an arch that is moved passes its greatest force, clamps in the contact set") {
  const Path way = followed(arch(0, moved_by(-4), "{first: 0.02, largest: 0.02}"));
  CAPTURE(way.why);
  REQUIRE(way.complete);
  const std::vector<double> force = way.force();
  const double greatest = *std::max_element(force.begin(), force.end());
  CHECK(force.back() < 0.8 * greatest);
  CHECK(turns_of(force) == 1);
}

}  // namespace arc_with_contact_tests
