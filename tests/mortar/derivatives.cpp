// Derivatives of runs with deformable surfaces that touch, against central differences of runs.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "identification/inverse/sensitivity.hpp"
#include "identification/inverse/uncertainty.hpp"
#include "mechanics/material/parameters.hpp"
#include "mortar/bodies.hpp"
#include "scene/model/config_number.hpp"
#include "scene/run/body_mesh.hpp"
#include "support/near.hpp"

using namespace langer;
using namespace langer::test;

namespace body_derivatives_tests {

namespace {

using Steps = std::vector<StepRecord>;

struct Differentiated {
  Steps steps;
  std::vector<Steps> derivatives;  // by step, by number
};

Differentiated differentiated(const BodiesScene& scene) {
  Run run(scene.mesh, scene.config, scene.config.material, scene.where);
  Sensitivity sensitivity(run, scene.config, scene.where);
  Differentiated out;
  RunListener each;
  each.of_whole = [&](const StepRecord& step, const SolveReport&) {
    out.steps.push_back(step);
    out.derivatives.push_back(sensitivity.now());
  };
  const RunEnd end = run.follow(sensitivity.along(each));
  CAPTURE(end.path.why);
  REQUIRE(end.path.complete);
  return out;
}

// The scene where a number is more by `by`.
BodiesScene changed(BodiesScene scene, const std::string& key, double by) {
  SolveConfig& config = scene.config;
  for (auto& [name, contact] : config.touching)
    if (key == "contacts." + name + ".friction") contact.friction += by;
  for (auto& [name, body] : config.materials)
    for (const MaterialParameter& p : parameters(*body.material))
      if (key == "materials." + name + "." + p.key) *p.value += by;
  if (key.starts_with("loads["))
    config = with_config_number(config, key, *config_number(config, key) + by);
  return scene;
}

double value_of(const BodiesScene& scene, const std::string& key) {
  for (const auto& [name, contact] : scene.config.touching)
    if (key == "contacts." + name + ".friction") return contact.friction;
  for (auto [name, body] : scene.config.materials)
    for (const MaterialParameter& p : parameters(*body.material))
      if (key == "materials." + name + "." + p.key) return *p.value;
  return *config_number(scene.config, key);
}

double norm(const std::vector<Vec3>& all) {
  double sum = 0;
  for (const Vec3& one : all) sum += one.squaredNorm();
  return std::sqrt(sum);
}

std::vector<Vec3> quotient(const std::vector<Vec3>& more, const std::vector<Vec3>& less, double h) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < more.size(); ++i) out.emplace_back((more[i] - less[i]) / (2 * h));
  return out;
}

double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return norm(quotient(a, b, 0.5));
}

Vec3 force_of(const StepRecord& step, const std::string& contact) {
  Vec3 force;
  for (int k = 0; k < 3; ++k) force[k] = step.scalars.at("force_" + contact + "_" + "xyz"[k]);
  return force;
}

void check(const std::string& text, const std::vector<std::string>& keys,
           const std::string& contact, double tolerance) {
  std::string list;
  for (const std::string& key : keys) list += (list.empty() ? "" : ", ") + ("\"" + key + "\"");
  const BodiesScene plain = bodies_scene(text);
  const Differentiated found = differentiated(bodies_scene(text + "sensitivity: [" + list + "]\n"));
  for (std::size_t i = 0; i < keys.size(); ++i) {
    CAPTURE(keys[i]);
    const double h = 3e-4 * std::abs(value_of(plain, keys[i]));
    const Steps more = solved(changed(plain, keys[i], h)).steps;
    const Steps less = solved(changed(plain, keys[i], -h)).steps;
    REQUIRE(more.size() == found.steps.size());
    const double rounding = 2e-13 / h;  // what a difference leaves of values that do not change
    std::size_t compared = 0;
    for (std::size_t s = 0; s < more.size(); ++s) {
      if (more[s].contacts.at(contact).status != less[s].contacts.at(contact).status) break;
      CAPTURE(s);
      const StepRecord& d = found.derivatives[s][i];
      const std::vector<Vec3> du = quotient(more[s].u, less[s].u, h);
      CHECK(distance(d.u, du) <= tolerance * norm(du) + rounding * norm(more[s].u));
      if (norm(du) > 1e3 * rounding * norm(more[s].u)) ++compared;
      const std::vector<Vec3> dr = quotient(more[s].reaction, less[s].reaction, h);
      CHECK(distance(d.reaction, dr) <= tolerance * norm(dr) + rounding * norm(more[s].reaction));
      const Vec3 dF = (force_of(more[s], contact) - force_of(less[s], contact)) / (2 * h);
      const double of_force = rounding * force_of(more[s], contact).norm();
      CHECK((force_of(d, contact) - dF).norm() <= tolerance * dF.norm() + of_force);
    }
    CHECK(compared > 0);
  }
}

const std::string skin =
    "    mesh: {geometry: {block: {origin: [0, 0, 0], size: [4, 1, 4], divisions: [5, 2, 4]}}}\n"
    "    material: {matrix: {yeoh: {a1: 0.05, a2: 0.05}}, volume: {quadratic: {d: 0.5}}}\n";

// A pad over the skin.
std::string pressed(const std::string& friction, const std::string& move) {
  return "bodies:\n  skin:\n" + skin +
         "  pad:\n"
         "    mesh: {geometry: {block: {origin: [1.1, 1, 0.8], size: [2, 1, 2], divisions: [3, 2, 3]}}}\n"
         "    material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.5}}}\n"
         "supports:\n  - {on: skin_bottom, hold: [x, y, z]}\n"
         "loads:\n  - {on: pad_top, displacement: " +
         move +
         "}\n"
         "contacts: {pad: {on: pad_bottom, against: skin_top, friction: " +
         friction +
         "}}\n"
         "path: {steps: 4}\nsolver: {newton: {relative: 1.0e-12}}\n";
}

const std::vector<std::string> numbers{"materials.skin.matrix.yeoh.a1",
                                       "materials.pad.matrix.neo_hooke.a1",
                                       "loads[0].displacement.y"};

}  // namespace

TEST_CASE("derivatives through bodies that touch are those of runs: without friction") {
  check(pressed("0", "{x: 0, y: -0.2, z: 0}"), numbers, "pad", 1e-5);
}

TEST_CASE(
    "derivatives through bodies that touch are those of runs: with friction, drawn sideways") {
  std::vector<std::string> all = numbers;
  all.push_back("contacts.pad.friction");
  check(pressed("0.04", "{x: 0, y: -0.2, z: 0}"), all, "pad", 1e-3);
  all.erase(all.begin() + 2);  // a history has no single number
  check(pressed("0.3",
                "{x: [{t: 0.5, to: 0}, {t: 1, to: 0.3}], y: [{t: 0.5, to: -0.2}, {t: 1, to: "
                "-0.2}], z: 0}"),
        all, "pad", 1e-3);
}

TEST_CASE("derivatives through a fold and a body that only friction holds are those of runs") {
  check(
      "bodies:\n  skin:\n" + skin +
          "  pad:\n"
          "    mesh: {geometry: {block: {origin: [1, 1, 1], size: [2, 1, 2], divisions: [3, 2, 3]}}}\n"
          "    material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.5}}}\n"
          "  plate:\n"
          "    mesh: {geometry: {block: {origin: [0, 2, 0], size: [4, 1, 4], divisions: [4, 2, 5]}}}\n"
          "    material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.5}}}\n"
          "supports: [{on: skin_bottom, hold: [x, y, z]}]\n"
          "loads: [{on: plate_top, displacement: {x: 0.05, y: -0.3, z: 0}}]\n"
          "contacts:\n"
          "  below: {on: pad_bottom, against: skin_top, friction: 0.4}\n"
          "  above: {on: pad_top, against: plate_bottom, friction: 0.4}\n"
          "path: {steps: 3}\nsolver: {newton: {relative: 1.0e-12}}\n",
      {"materials.skin.matrix.yeoh.a1", "materials.pad.matrix.neo_hooke.a1"}, "below", 1e-3);
}

TEST_CASE("derivatives of a killed run of two bodies go on with the same digits") {
  const BodiesScene scene =
      bodies_scene(pressed("0.05", "{x: 0.1, y: -0.2, z: 0}") +
                   "sensitivity: [materials.skin.matrix.yeoh.a1, contacts.pad.friction]\n");
  const Differentiated whole = differentiated(scene);
  Run run(scene.mesh, scene.config, scene.config.material, scene.where);
  Sensitivity sensitivity(run, scene.config, scene.where);
  for (std::size_t s = 0; s < 2; ++s) {
    run.replay(whole.steps[s]);
    sensitivity.kept(whole.steps[s]);
  }
  run.resume(whole.steps[1], whole.steps[0]);
  std::size_t next = 2;
  RunListener each;
  each.of_whole = [&](const StepRecord& step, const SolveReport&) {
    CHECK(step.scalars == whole.steps[next].scalars);
    CHECK(step.point_fields == whole.steps[next].point_fields);
    ++next;
  };
  run.follow(sensitivity.along(each));
  CHECK(next == whole.steps.size());
}

TEST_CASE("what derivatives through bodies do not know is refused at its key") {
  const auto said = [](const std::string& more) {
    try {
      const BodiesScene scene = bodies_scene(pressed("0", "{x: 0, y: -0.2, z: 0}") + more);
      Run run(scene.mesh, scene.config, scene.config.material, scene.where);
      const Sensitivity sensitivity(run, scene.config, scene.where);
    } catch (const Failure& failure) {
      CHECK(failure.code() == Exit::config);
      return std::string(failure.what());
    }
    return std::string("accepted");
  };
  CHECK(said("sensitivity: [materials.skin.matrix.yeoh.a1]\n") == "accepted");
  CHECK(said("sensitivity: [contacts.pad.friction]\n").find("friction above 0") !=
        std::string::npos);
  CHECK(said("sensitivity: [materials.skin.matrix.yeoh.a9]\n").find("a number of the scene") !=
        std::string::npos);
  CHECK(said("sensitivity: [materials.skin.matrix.yeoh.a1]\n"
             "dynamics: {density_kg_m3: 1100, step: 1.0e-4}\n")
            .find("none in motion") != std::string::npos);
}

// A surface that touches itself moves with the thickness below it, which its gap would have to
// know.
TEST_CASE(
    "the thickness of a body whose surfaces touch is refused as a number to differentiate by") {
  auto loaded = read_config<SolveConfig>(parse_yaml(
      "mesh: {geometry: {block: {size: [2, 1, 2], divisions: [2, 2, 2]}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.5}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\nloads: [{on: top, displacement: {y: -0.1}}]\n"
      "contacts: {fold: {on: top, against: top}}\n"
      "sensitivity: [\"mesh.geometry.block.size[1]\"]\n",
      "scene.yaml"));
  expand_bodies(loaded.config, loaded.where.tree);
  const Mesh mesh = body_mesh(loaded.config, "", loaded.where);
  CHECK_THROWS_WITH_AS(Run(mesh, loaded.config, loaded.config.material, loaded.where),
                       doctest::Contains("and surfaces touch, which would move"), Failure);
}

// The pad is moved at a side whose lowest nodes touch the skin.
TEST_CASE("derivatives of reactions at nodes that are moved and touch are those of runs") {
  std::string text = pressed("0.3", "{x: 0.05, y: -0.1, z: 0}");
  const std::string from = "pad_top";
  text.replace(text.find(from), from.size(), "pad_x_max");
  check(text, {"materials.skin.matrix.yeoh.a1"}, "pad", 1e-3);
}

// A number known to 10 % moves the force by the derivative.
TEST_CASE("the force between bodies has the deviation that the parameters give it") {
  const std::string key = "materials.skin.matrix.yeoh.a1";
  const std::string text = pressed("0.3", "{x: 0, y: -0.2, z: 0}");
  const BodiesScene scene = bodies_scene(text + "sensitivity: [" + key + "]\n");
  ParameterKnowledge known;
  known.keys = {key};
  known.names = {"a1"};
  known.follow = MatX::Identity(1, 1);
  const double deviation = 0.005;  // [MPa]
  known.covariance = MatX::Constant(1, 1, deviation * deviation);
  Run run(scene.mesh, scene.config, scene.config.material, scene.where);
  Sensitivity sensitivity(run, scene.config, scene.where);
  const Uncertainty uncertainty(known, run, sensitivity);
  std::vector<ForceUncertainty> forces;
  RunListener each;
  each.of_whole = [&](const StepRecord& step, const SolveReport&) {
    forces = uncertainty.of(step);
  };
  REQUIRE(run.follow(uncertainty.beside(sensitivity.observer()).along(each)).path.complete);
  REQUIRE(forces.size() == 2);  // and the reaction of the set that is moved
  CHECK(forces[0].name == "force_pad");
  const BodiesScene plain = bodies_scene(text);
  const double h = 3e-4 * 0.05;
  const double more = solved(changed(plain, key, h)).last().scalars.at("force_pad");
  const double less = solved(changed(plain, key, -h)).last().scalars.at("force_pad");
  CHECK(forces[0].deviation == near(deviation * (more - less) / (2 * h), 1e-3));
  CHECK(forces[0].value == near(0.5 * (more + less), 1e-6));
}

}  // namespace body_derivatives_tests
