// What an accuracy may be asked of beside forces, and at which place of the path: the bars hold
// against much finer solutions.
#include <doctest/doctest.h>

#include <cmath>

#include <fmt/format.h>

#include "accuracy/estimate/error_estimate.hpp"
#include "accuracy/estimate/recovered_path.hpp"
#include "scene/run/body_mesh.hpp"
#include "scene/run/step_forces.hpp"
#include "support/estimate_of.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace {

struct Judged {
  std::vector<ErrorEstimate> errors;
  std::vector<StepForces> path;

  const ErrorEstimate& of(const std::string& name) const { return test::estimate_of(errors, name); }
};

// The scene as it is, with its estimate by refinement; no level is chosen.
Judged judged(const std::string& scene, const std::string& accuracy) {
  const SolveConfig config =
      test::config_of(scene + "accuracy: " + accuracy + "\nestimate: refinement\n");
  Run run(body_mesh(config, "", test::nowhere), config, config.material, test::nowhere);
  Judged out;
  const RunEnd end = run.follow(collecting({}, config, run, out.path));
  REQUIRE(end.path.complete);
  out.errors =
      estimated(config, config.material, test::nowhere, run, end.last, out.path, {}).at_end;
  return out;
}

std::vector<StepForces> path_of(const std::string& scene, const std::string& accuracy) {
  const SolveConfig config = test::config_of(scene + "accuracy: " + accuracy + "\n");
  return solved_path(config, config.material, test::nowhere).path;
}

// A round membrane under pressure, clamped at its rim.
std::string dome(int along, int through) {
  return fmt::format(
      "mesh: {{geometry: {{section: {{of: axisymmetric, size: [10, 1], divisions: [{}, {}]}}}}, cells: hex27}}\n"
      "supports: [{{on: x_max, hold: [x, y]}}]\n"
      "loads: [{{on: bottom, pressure: 0.004}}]\n"
      "material: {{matrix: {{neo_hooke: {{a1: 0.05}}}}, volume: {{quadratic: {{d: 1.0e-3}}}}}}\n"
      "path: {{first: 0.25, largest: 0.25}}\nstability: off\n",
      along, through);
}

// A sphere pressed into a disc and lifted off again.
std::string press_and_lift(double edge) {
  return fmt::format(
      "mesh:\n"
      "  geometry: {{indented_disc: {{size: [8, 4], radius: 2.5, depth: 0.4, edge: {}}}}}\n"
      "  sets: {{contact: {{of: top, within: {{cylinder: {{axis: y, radius: 2}}}}}}}}\n"
      "material: {{matrix: {{neo_hooke: {{a1: 0.02}}}}, volume: {{quadratic: {{d: 1.0e-2}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y, z]}}]\n"
      "contacts:\n"
      "  sphere:\n"
      "    on: contact\n"
      "    rigid: {{sphere: {{radius: 2.5, centre: [0, 6.5, 0]}}}}\n"
      "    motion: [{{t: 0.5, to: [0, -0.4, 0]}}, {{t: 1, to: [0, 0.1, 0]}}]\n"
      "path: {{first: 0.25, largest: 0.25}}\nstability: off\n",
      edge);
}

}  // namespace

TEST_CASE("judged quantities: the bar of a dome's height holds at the end and at every step") {
  const std::string asked = "{of: apex_height, within: 1%}";
  const std::vector<StepForces> fine = path_of(dome(40, 8), asked);
  const Judged at_end = judged(dome(12, 4), asked);
  const ErrorEstimate& e = at_end.of("apex_height");
  CHECK(e.asked);
  CHECK(std::abs(e.of.value - fine.back().of.at("apex_height")) <= e.total());
  CHECK(e.in_percent(e.total()) < 5);

  const Judged worst = judged(dome(12, 4), "{of: apex_height, at: every_step, within: 1%}");
  const ErrorEstimate& w = worst.of("apex_height");
  REQUIRE(w.largest);
  CHECK(*w.largest == near(at_end.of("apex_height").of.value));
  double largest_error = 0;
  for (const StepForces& step : worst.path)
    largest_error = std::max(
        largest_error, std::abs(step.of.at("apex_height") - force_at(fine, "apex_height", step.t)));
  CHECK(largest_error <= w.total());
  CHECK(w.in_percent(w.total()) == near(100 * w.total() / *w.largest));
}

TEST_CASE("judged quantities: a force that ends at 0 is judged where it is largest") {
  const std::string force = "{of: force, at: every_step, within: 1%}";
  const std::vector<StepForces> fine = path_of(press_and_lift(0.03), force);
  const Judged found = judged(press_and_lift(0.07), force);
  CHECK(found.path.back().of.at("force") == 0);
  const ErrorEstimate& e = found.of("force");
  CHECK(e.t < 1);
  double largest_error = 0;
  for (const StepForces& step : found.path)
    largest_error =
        std::max(largest_error, std::abs(step.of.at("force") - force_at(fine, "force", step.t)));
  CHECK(largest_error <= e.total());
  CHECK(e.total() > 0);

  const std::string stress = "{of: von_mises_max, at: maximum, within: 10%}";
  const std::vector<StepForces> finer = path_of(press_and_lift(0.03), stress);
  const Judged pressed = judged(press_and_lift(0.07), stress);
  const ErrorEstimate& s = pressed.of("von_mises_max");
  CHECK(s.asked);
  CHECK(s.t == near(0.5));
  CHECK(std::abs(s.of.value - force_at(finer, "von_mises_max", s.t)) <= s.total());
}

TEST_CASE("judged quantities: by default a lifted indenter has the bar of its largest force") {
  const SolveConfig config = test::config_of(press_and_lift(0.1));
  Run run(body_mesh(config, "", test::nowhere), config, config.material, test::nowhere);
  RecoveredPath recovered(run, config, true);
  const RunEnd end = run.follow(recovered.beside({}).along({}));
  REQUIRE(end.path.complete);
  const PathErrors found =
      recovered.errors(end.last, valued(config, run.scene, run.mesh, end.last));
  REQUIRE(!found.at_end.empty());
  const ErrorEstimate& e = found.at_end.front();
  CHECK(e.of.name == "force");
  CHECK(e.of.value > 0);
  CHECK(e.t == near(0.5));
  const std::vector<StepForces> fine = path_of(press_and_lift(0.03), "{of: force, within: 1%}");
  CHECK(std::abs(e.of.value - force_at(fine, "force", 0.5)) <= e.total());
}

TEST_CASE("judged quantities: the greatest pull counts what lies between the steps") {
  const auto step = [](double t, double pull) {
    StepForces forces{t, {{"pull_off", pull}}, {{"pull_off", 4}}};
    forces.pull = pull;
    return forces;
  };
  // 1 - (t - 0.45)^2 at three places
  std::vector<StepForces> path;
  for (const double t : {0.2, 0.4, 0.6, 0.9}) append_step(path, step(t, 1 - std::pow(t - 0.45, 2)));
  CHECK(path.back().of.at("pull_off") == near(1 - 0.05 * 0.05));
  CHECK(pull_between_steps(path) == near(0.05 * 0.05, 1e-6));
}

namespace {

// A sphere that is pressed on a disc and drawn off; its bonds are soft enough for these cells.
std::string pulled_off(double edge, const std::string& more_of_bonds = "",
                       const std::string& path = "first: 0.05, largest: 0.05") {
  return fmt::format(
      "mesh:\n"
      "  geometry: {{indented_disc: {{size: [9, 6], radius: 5, depth: 0.06, edge: {}}}}}\n"
      "  sets: {{contact: {{of: top, within: {{cylinder: {{axis: y, radius: 0.9}}}}}}}}\n"
      "material: {{matrix: {{neo_hooke: {{a1: 0.05}}}}, volume: {{quadratic: {{d: 1.0e-3}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y, z]}}]\n"
      "contacts:\n"
      "  sphere:\n"
      "    on: contact\n"
      "    rigid: {{sphere: {{radius: 5, centre: [0, 11, 0]}}}}\n"
      "    adhesion: {{work: 5.0e-4, stiffness: 0.75{}}}\n"
      "    motion: [{{t: 0.3, to: [0, -0.06, 0]}}, {{t: 1, to: [0, 0.05, 0]}}]\n"
      "path: {{{}}}\nsolver: {{newton: {{iterations: 12}}}}\n"
      "stability: off\n",
      edge, more_of_bonds, path);
}

}  // namespace

TEST_CASE("judged quantities: the bar of the greatest pull holds and tells something") {
  const ErrorEstimate e = judged(pulled_off(0.1), "{of: pull_off, within: 1%}").of("pull_off");
  const std::vector<StepForces> fine = path_of(pulled_off(0.05), "{of: pull_off, within: 1%}");
  CHECK(e.of.value > 0);
  CHECK(std::abs(e.of.value - fine.back().of.at("pull_off")) <= e.total());
  CHECK(e.total() < 0.2 * e.of.value);
}

TEST_CASE("judged quantities: bonds with a viscosity find their increments") {
  const auto greatest = [](const std::string& path) {
    const std::string scene = pulled_off(0.1, ", viscosity: 5.0e-5", "seconds: 1" + path);
    return path_of(scene, "{of: pull_off, within: 1%}").back().of.at("pull_off");
  };
  const double fine = greatest(", first: 0.005, largest: 0.005");
  CHECK(greatest("") == near(fine, 0.02));
  CHECK(greatest(", time_error: 1.0e-4") == near(fine, 0.005));
}

TEST_CASE("judged quantities: increments meet the top of a pull without a delay of the bonds") {
  const auto greatest = [](const std::string& path) {
    return path_of(pulled_off(0.1, "", path), "{of: pull_off, within: 1%}")
        .back()
        .of.at("pull_off");
  };
  const double fine = greatest("first: 0.005, largest: 0.005");
  CHECK(greatest("first: 0.125, largest: 0.125") == near(fine, 0.02));
  CHECK(greatest("steps: 8") < 0.96 * fine);  // which are as they are asked for
}

TEST_CASE("judged quantities: what a scene does not have is refused by name") {
  const auto said = [](const std::string& accuracy) {
    try {
      judged(press_and_lift(0.1), accuracy);
    } catch (const Failure& failure) {
      CHECK(failure.code() == Exit::config);
      return std::string(failure.what());
    }
    return std::string("accepted");
  };
  CHECK(said("{of: pull_off, within: 1%}").find("expected one of force") != std::string::npos);
  CHECK(said("{of: displacement@P, within: 1%}").find("displacement@P") != std::string::npos);
  CHECK(said("{of: apex, within: 1%}").find("apex_height, pull_off or von_mises_max") !=
        std::string::npos);
}

TEST_CASE("judged quantities: the largest stress of a clamped block that is pulled has no bar") {
  const std::string scene =
      "mesh: {geometry: {block: {size: [10, 4, 6], divisions: [10, 4, 6]}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-4}}}\n"
      "supports: [{on: x_min, hold: [x, y, z]}, {on: x_max, hold: [y, z]}]\n"
      "loads: [{on: x_max, displacement: {x: 2}}]\npath: {steps: 2}\nstability: off\n";
  CHECK(judged(scene, "5%").of("von_mises_max").grows);
  const SolveConfig config = test::config_of(scene + "estimate: recovery\n");
  Run run(body_mesh(config, "", test::nowhere), config, config.material, test::nowhere);
  RecoveredPath recovered(run, config, true);
  const RunEnd end = run.follow(recovered.beside({}).along({}));
  REQUIRE(end.path.complete);
  const auto found = valued(config, run.scene, run.mesh, end.last);
  const auto errors = recovered.errors(end.last, found, true).at_end;
  CHECK(test::estimate_of(errors, "von_mises_max").grows);
}

// limits of much finer meshes: sections of 96 x 32 and 192 x 64 cells, blocks with edges of 0.09
// and 0.07 contact radii
TEST_CASE("judged quantities: the stress of a thin layer and a point beside an indenter") {
  const Judged layers = judged(
      "mesh:\n  geometry: {section: {of: axisymmetric, size: [12, 4], divisions: [24, 8]}}\n"
      "  bodies: [{name: fat, thickness: 3}, {name: skin, thickness: 1}]\n"
      "materials:\n"
      "  fat: {material: {matrix: {neo_hooke: {a1: 0.01}}, volume: {quadratic: {d: 1.0e-3}}}}\n"
      "  skin: {material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1.0e-3}}}}\n"
      "supports: [{on: bottom, hold: [x, y]}]\n"
      "contacts: {s: {on: top, rigid: {sphere: {radius: 3, centre: [0, 7, 0]}}, friction: 0.3, "
      "motion: [{t: 1, to: [0, -0.6, 0]}]}}\npath: {steps: 3}\n",
      "50%");
  const ErrorEstimate& stress = layers.of("von_mises_max");
  CHECK(std::abs(stress.of.value - 0.136) < stress.total());
  const Judged point = judged(
      "mesh:\n  geometry: {indented_block: {origin: [-6, 0, -6], size: [12, 4, 12], radius: 2, "
      "depth: 0.5, edge: 0.175}}\n  points: {q: [3, 4, 0]}\n"
      "material: {matrix: {yeoh: {a1: 0.02, a2: 0.05, a3: 0.01}}, volume: {quadratic: {d: 0.01}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\n"
      "contacts: {p: {on: top, rigid: {ellipsoid: {half_axes: [3, 1.5, 1], centre: [0, 5.5, 0]}}, "
      "motion: [{t: 1, to: [0, -0.5, 0]}]}}\npath: {steps: 5}\n",
      "50%");
  const ErrorEstimate& moved = point.of("displacement_q");
  CHECK(std::abs(moved.of.value - 0.0338) < moved.total());
}
