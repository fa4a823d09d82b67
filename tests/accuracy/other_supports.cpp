// Scenes that no study stands for: what ends with success is within what was asked for, and its bar
// holds, whatever holds the body.
#include <doctest/doctest.h>

#include <cmath>

#include <fmt/format.h>

#include "accuracy/refinement/accuracy.hpp"
#include "mechanics/element/surface.hpp"
#include "scene/run/body_mesh.hpp"
#include "scene/run/run.hpp"
#include "scene/run/step_forces.hpp"
#include "support/estimate_of.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace {

struct Ended {
  std::vector<ErrorEstimate> errors;
  std::vector<std::string> levels;
  SolveConfig config;
  bool met = false;
  std::string words;  // where it is not met

  const ErrorEstimate& of(const std::string& name) const { return test::estimate_of(errors, name); }
};

Ended asked_for(const std::string& scene, const std::string& accuracy) {
  const SolveConfig config = test::config_of(scene + "accuracy: " + accuracy + "\n");
  Accuracy accurate(Voice{"", true}, config, config.material, test::nowhere, false);
  Ended ended;
  for (bool again = true; again;) {
    ended.config = accurate.config();
    try {
      Run run(body_mesh(ended.config, "", test::nowhere), ended.config, ended.config.material,
              test::nowhere);
      std::vector<StepForces> path;
      const RunEnd end = run.follow(collecting({}, ended.config, run, path));
      if (!end.path.complete)
        throw Failure(Exit::not_converged, Error{{}, "", end.path.why, "", ""});
      ended.errors =
          estimated(ended.config, ended.config.material, test::nowhere, run, end.last, path, {})
              .at_end;
      again = accurate.decide(ended.errors).action == Decision::Action::refine;
    } catch (const Failure& failure) {
      if (failure.code() != Exit::not_converged) throw;
      ended.words = failure.what();
      again = accurate.retry_after(failure);
    }
  }
  try {
    accurate.require(ended.errors, "solution.h5");
    ended.met = true;
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::not_accurate);
    ended.words = failure.what();
  }
  return ended;
}

// limit of the quantity, and by how much it is unknown, relative
void judge(const Ended& ended, const std::string& name, double limit, double unknown,
           double asked) {
  const ErrorEstimate& e = ended.of(name);
  const double off = std::abs(e.of.value / limit - 1);
  CAPTURE(e.of.value);
  CAPTURE(off);
  CAPTURE(e.in_percent(e.total()));
  CAPTURE(ended.words);
  CHECK(off <= 0.01 * e.in_percent(e.total()) + unknown);
  if (ended.met) CHECK(off <= 0.01 * asked + unknown);
}

// A section of 10 x 6 mm, held along y from the left to `held`: the end of what is held is a
// crack's tip.
std::string ligament(double held, const std::string& cells, const std::string& divisions) {
  return fmt::format(
      "mesh:\n"
      "  geometry: {{section: {{of: plane_strain, size: [10, 6], divisions: {}, thickness: 3}}}}\n"
      "  cells: {}\n"
      "  sets: {{held: {{of: bottom, within: {{box: {{from: [0, 0, -1], to: [{}, 0, 3]}}}}}}}}\n"
      "supports: [{{on: held, hold: [y]}}, {{on: x_min, hold: [x]}}]\n"
      "material: {{matrix: {{neo_hooke: {{a1: 0.1}}}}, volume: {{quadratic: {{d: 1.0e-3}}}}}}\n"
      "loads: [{{on: top, displacement: {{y: 1.5}}}}]\n"
      "path: {{first: 0.25, largest: 0.25}}\n"
      "stability: off\n",
      divisions, cells, held);
}

double reaction_of(const std::string& scene) {
  const SolveConfig config = test::config_of(scene);
  for (const Valued& q : end_of_path(config, config.material, test::nowhere))
    if (q.name == "reaction_top") return q.value;
  return 0;
}

}  // namespace

TEST_CASE("other supports: a notch's first order shows in its levels, and its bars hold") {
  for (const double held : {5.0, 6.0}) {
    CAPTURE(held);
    // of first order in the cells' length: half of it takes half of the error away
    const double coarse = reaction_of(ligament(held, "hex27", "[20, 12]"));
    const double fine = reaction_of(ligament(held, "hex27", "[40, 24]"));
    const double limit = 2 * fine - coarse;
    const double unknown = 0.2 * std::abs(fine / limit - 1);
    int met = 0;
    for (const double asked : {3.0, 0.5}) {
      CAPTURE(asked);
      const Ended ended = asked_for(ligament(held, "hex8", "[10, 6]"), fmt::format("{}%", asked));
      judge(ended, "reaction_top", limit, unknown, asked);
      met += ended.met;
      const ErrorEstimate& e = ended.of("reaction_top");
      CHECK(e.order < 2);  // what cells without a notch have
      if (asked > 1) CHECK(e.order < 1.4);
      // the stress at the end of what is held has no limit
      CHECK(ended.of("von_mises_max").grows);
      CHECK(in_words(ended.of("von_mises_max")).find("grows without bound") != std::string::npos);
    }
    CHECK(met > 0);
  }
}

namespace {

// a pressure on a part of the top of a block
std::string pressed_part(double from, double to) {
  return fmt::format(
      "mesh:\n"
      "  geometry: {{block: {{size: [10, 5, 8], divisions: [10, 5, 8]}}}}\n"
      "  points: {{P: [5, 5, 4], Q: [10, 5, 4]}}\n"
      "  sets: {{patch: {{of: top, within: {{box: {{from: [{}, 5, 2], to: [{}, 5, 6]}}}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y, z]}}]\n"
      "material: {{matrix: {{neo_hooke: {{a1: 0.05}}}}, volume: {{quadratic: {{d: 1.0e-3}}}}}}\n"
      "loads: [{{on: patch, pressure: 0.04}}]\n"
      "path: {{first: 0.5, largest: 0.5}}\n"
      "stability: off\n",
      from, to);
}

double area_of(const Mesh& mesh, const std::string& set) {
  double area = 0;
  for (const Facet& facet : mesh.facet_sets.at(set)) area += nodal_areas(mesh, {facet}).sum();
  return area;
}

}  // namespace

TEST_CASE("other supports: a pressed patch has its area on every mesh of an estimate") {
  for (const auto& [from, to] : {std::pair{3.0, 7.0}, {2.5, 7.2}}) {
    const auto shown = from;
    CAPTURE(shown);
    const SolveConfig asked = test::config_of(pressed_part(from, to) + "accuracy: 5%\n");
    SolveConfig config = asked;
    REQUIRE(choose_accuracy(config, config.material));
    for (const double factor : {1.0, 0.6, 0.35}) {
      for (const int parts : {4, 3, 2}) {
        SolveConfig other = config;
        scale_cells(other.mesh->geometry, factor);
        family_of(other.mesh->geometry)->parts = parts;
        CAPTURE(factor);
        CAPTURE(parts);
        CHECK(area_of(test::mesh_in(other), "patch") == near(4 * (to - from), 1e-12));
      }
    }
  }
  const Ended ended = asked_for(pressed_part(3, 7), "5%");
  CAPTURE(ended.words);
  CHECK(ended.met);
}

namespace {

std::string pressed_and_lifted(double back) {
  return fmt::format(
      "mesh: {{geometry: {{indented_block: {{origin: [-12, 0, -12], size: [24, 4, 24], radius: 2.5, depth: 0.6, edge: 0.25}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y, z]}}]\n"
      "material: {{matrix: {{yeoh: {{a1: 0.269, a2: 0.376, a3: 0.415}}}}, volume: {{quadratic: {{d: 1.0e-4}}}}}}\n"
      "contacts:\n"
      "  ball:\n"
      "    rigid: {{sphere: {{radius: 2.5, centre: [0, 6.5, 0]}}}}\n"
      "    motion: [{{t: 0.5, to: [0, -0.6, 0]}}, {{t: 1, to: [0, {}, 0]}}]\n"
      "stability: off\n",
      back);
}

}  // namespace

TEST_CASE("other supports: meshes of a sheared block that agree by chance have a longer bar") {
  const auto sheared = [](const std::string& divisions) {
    return "mesh: {geometry: {block: {size: [2.25, 0.85, 1.16], divisions: " + divisions +
           "}}}\n"
           "supports: [{on: x_min, hold: [x, y, z]}]\n"
           "loads: [{on: x_max, displacement: {x: 0, y: 0, z: 0.1195}}]\n"
           "material: {matrix: {yeoh: {a1: 0.103, a2: 0.0515, a3: 0.0206}}, volume: {quadratic: {d: 4.75e-05}}, fibres: [{hgo: {c1: 0.0509, c2: 1.31}, alpha: -36.4, kappa: 0}]}\n"
           "stability: off\n";
  };
  const ErrorEstimate few = asked_for(sheared("[10, 4, 5]"), "2%").of("reaction_x_max");
  const ErrorEstimate many = asked_for(sheared("[48, 16, 16]"), "2%").of("reaction_x_max");
  CHECK(few.scatter > 0);
  CHECK(std::abs(few.of.value - many.limit()) > 2e-3 * few.of.value);
  CHECK(few.total() > std::abs(few.of.value - many.limit()));
  CHECK(few.total() < 1e-2 * few.of.value);
}

TEST_CASE("pressed and lifted: the largest force is judged, unless the config says where") {
  const Ended lifted = asked_for(pressed_and_lifted(0.1), "5%");
  const ErrorEstimate& force = lifted.of("force");
  CHECK(force.t == near(0.5, 1e-12));
  CHECK(force.of.value > 1);
  CHECK(in_words(force).find("force at t = 0.5") != std::string::npos);
  // still pressed by more than half at its end: that is judged
  CHECK(asked_for(pressed_and_lifted(-0.55), "5%").of("force").t == 1);
  const Ended largest = asked_for(pressed_and_lifted(-0.55), "{at: maximum, within: 5%}");
  CHECK(largest.of("force").t == near(0.5, 1e-12));
}

namespace {

// a sheet that is held at its rims, nothing below it, and a sphere that presses it
// edge: of the block, and keys that follow it
std::string trampoline(const std::string& cells, const std::string& edge, const std::string& more) {
  return fmt::format(
      "mesh: {{geometry: {{indented_block: {{origin: [-8, 0, -8], size: [16, 2, 16], radius: 2.5, depth: 0.8, edge: {}}}}}, cells: {}}}\n"
      "supports: [{{on: x_min, hold: [x, y, z]}}, {{on: x_max, hold: [x, y, z]}}, {{on: z_min, hold: [x, y, z]}}, {{on: z_max, hold: [x, y, z]}}]\n"
      "material: {{matrix: {{yeoh: {{a1: 0.269, a2: 0.376, a3: 0.415}}}}, volume: {{quadratic: {{d: 1.0e-4}}}}}}\n"
      "contacts: {{ball: {{rigid: {{sphere: {{radius: 2.5, centre: [0, 4.5, 0]}}}}, {}}}}}\n"
      "stability: off\n",
      edge, cells, more);
}

}  // namespace

TEST_CASE("other supports: a sheet held at its rims is judged by cells that bend") {
  const std::string moved = "motion: [{t: 1, to: [0, -0.6, 0]}]";
  const SolveConfig reference = test::config_of(trampoline("hex27", "0.35, even: [8, 8]", moved));
  const double limit = end_of_path(reference, reference.material, test::nowhere).front().value;
  const Ended ended = asked_for(trampoline("hex8", "0.3", moved), "10%");
  judge(ended, "force", limit, 0.01, 10);
  // cells that grow towards the rims leave 1.8 %, however short those under the sphere are
  CHECK(std::abs(ended.of("force").of.value / limit - 1) < 0.01);
  CHECK(ended.met);
  CHECK(ended.config.mesh->cells == CellType::hex27);
  // what a study of bodies on their bottom promises is not said of a sheet
  SolveConfig config = test::config_of(trampoline("hex8", "0.3", moved) + "accuracy: 5%\n");
  const auto chosen = choose_accuracy(config, config.material);
  REQUIRE(chosen.has_value());
  CHECK(!chosen->shown);
  CHECK(chosen->words.find("study") == std::string::npos);
}

TEST_CASE("under force control the travel is judged") {
  const std::string scene =
      "mesh: {geometry: {indented_block: {origin: [-12, 0, -12], size: [24, 4, 24], radius: 2.5, depth: 0.6, edge: 0.25}}, sets: {above: {of: top, within: {cylinder: {axis: y, radius: 2.5}}}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\n"
      "material: {matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, volume: {quadratic: {d: 1.0e-4}}}\n"
      "contacts: {ball: {rigid: {sphere: {radius: 2.5, centre: [0, 6.5, 0]}}, on: above, control: {force: 3}}}\n"
      "stability: off\n";
  const Ended ended = asked_for(scene, "5%");
  const ErrorEstimate& travel = ended.of("travel_ball");
  CHECK(travel.of.unit == "mm");
  CHECK(travel.of.value > 0.3);
  CHECK(travel.total() > 0);
  CHECK(ended.met);
  CHECK_THROWS_AS(asked_for(scene, "{of: torque, within: 5%}"), Failure);
}
