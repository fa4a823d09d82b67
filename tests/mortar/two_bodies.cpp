// Two deformable bodies in contact against closed forms, and against one body on a rigid plane.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "mortar/bodies.hpp"
#include "support/near.hpp"

using namespace langer;
using namespace langer::test;

namespace {

const std::string soft = "{matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.5}}}";

std::string block(const std::string& origin, const std::string& size, const std::string& divisions,
                  const std::string& material) {
  return "{mesh: {geometry: {block: {origin: " + origin + ", size: " + size +
         ", divisions: " + divisions + "}}}, material: " + material + "}";
}

std::vector<int> contact_nodes(const BodiesScene& scene, const std::string& a,
                               const std::string& b) {
  std::set<int> nodes(scene.mesh.node_sets.at(a).begin(), scene.mesh.node_sets.at(a).end());
  nodes.insert(scene.mesh.node_sets.at(b).begin(), scene.mesh.node_sets.at(b).end());
  return {nodes.begin(), nodes.end()};
}

// a body on another one, both free to widen
std::string patch(const std::string& pad_divisions, const std::string& on,
                  const std::string& against) {
  return "bodies:\n"
         "  skin: " + block("[0, 0, 0]", "[2, 1, 2]", "[4, 2, 3]", soft) + "\n" +
         "  pad: " + block("[0, 1, 0]", "[2, 1, 2]", pad_divisions, soft) + "\n" +
         "supports:\n"
         "  - {on: skin_bottom, hold: [y]}\n"
         "  - {on: skin_x_min, hold: [x]}\n"
         "  - {on: skin_z_min, hold: [z]}\n"
         "  - {on: pad_x_min, hold: [x]}\n"
         "  - {on: pad_z_min, hold: [z]}\n"
         "loads: [{on: pad_top, displacement: {y: -0.3}}]\n"
         "contacts: {pad: {on: " + on + ", against: " + against + "}}\n"
         "path: {first: 0.5, largest: 0.5}\n";
}

double spread(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return (*high - *low) / std::abs(*high);
}

}  // namespace

TEST_CASE("two bodies whose meshes do not match transmit a uniform pressure") {
  for (const auto& [on, against] :
       {std::pair{"pad_bottom", "skin_top"}, std::pair{"skin_top", "pad_bottom"}}) {
    CAPTURE(on);
    const BodiesScene scene = bodies_scene(patch("[3, 2, 5]", on, against));
    const BodiesSolution solution = solved(scene);
    CHECK(spread(solution.last().cell_fields.at("von_mises")) < 1e-10);
    CHECK(spread(solution.last().cell_fields.at("J")) < 1e-10);
    const auto [force, moment] =
        imbalance(scene, solution.last(), contact_nodes(scene, "pad_bottom", "skin_top"));
    CHECK(force < 1e-12);
    CHECK(moment < 1e-10);
  }
}

TEST_CASE("two equal bodies pressed together are one against a frictionless plane") {
  const auto scene_of = [](const std::string& pad, const std::string& moved,
                           const std::string& contact) {
    return "bodies:\n  skin: " + block("[0, 0, 0]", "[3, 1, 2]", "[5, 3, 4]", soft) + "\n" + pad +
           "supports:\n  - {on: skin_bottom, hold: [x, y, z]}\n" + moved + "contacts: {" + contact +
           "}\npath: {first: 0.25, largest: 0.25}\n";
  };
  const BodiesScene two = bodies_scene(
      scene_of("  pad: " + block("[0, 1, 0]", "[3, 1, 2]", "[5, 3, 4]", soft) + "\n",
               "loads:\n  - {on: pad_top, displacement: {x: 0, y: -0.4, z: 0}}\n",
               "pad: {on: pad_bottom, against: skin_top}"));
  const BodiesScene one = bodies_scene(scene_of(
      "", "",
      "plane: {on: skin_top, rigid: {plane: {point: [0, 1, 0], normal: [0, -1, 0]}}, motion: [{t: 1, to: "
      "[0, -0.2, 0]}]}"));
  const StepRecord of_two = solved(two).last();
  const StepRecord of_one = solved(one).last();
  const double force = of_two.scalars.at("force_pad");
  CHECK(force == near(of_one.force_ind.norm(), 1e-8));
  const int pad_first = two.mesh.node_sets.at("skin_bottom").front();
  for (int i = 0; i < one.mesh.n_nodes(); ++i) {
    const Vec3 u = of_two.u[static_cast<std::size_t>(pad_first + i)];
    CHECK((u - of_one.u[static_cast<std::size_t>(i)]).norm() < 1e-8);
  }
}

TEST_CASE("a block slides over a finer one with a force of friction times pressure") {
  const std::string stiff = "{matrix: {neo_hooke: {a1: 5}}, volume: {quadratic: {d: 0.01}}}";
  const BodiesScene scene = bodies_scene(
      "bodies:\n"
      "  skin: " + block("[0, 0, 0]", "[4, 0.5, 1]", "[12, 1, 3]", stiff) + "\n" +
      "  pad: " + block("[0.5, 0.5, 0.2]", "[1, 0.5, 0.6]", "[2, 1, 2]", stiff) + "\n" +
      "supports:\n"
      "  - {on: skin_bottom, hold: [x, y, z]}\n"
      "loads:\n"
      "  - {on: pad_top, displacement: {x: [{t: 0.1, to: 0}, {t: 1, to: 1.9}], y: [{t: 0.1, to: "
      "-1.0e-6}, {t: 1, to: -1.0e-6}], z: 0}}\n"
      "contacts: {pad: {on: pad_bottom, against: skin_top, friction: 0.3}}\n"
      "path: {first: 0.05, largest: 0.05}\n");
  const BodiesSolution solution = solved(scene);
  int sliding = 0;
  for (const StepRecord& step : solution.steps) {
    if (step.t < 0.3) continue;
    const double normal = std::abs(step.scalars.at("force_pad_y"));
    const double along = std::abs(step.scalars.at("force_pad_x"));
    CHECK(along == near(0.3 * normal, 1e-6));
    ++sliding;
    const auto [force, moment] =
        imbalance(scene, step, contact_nodes(scene, "pad_bottom", "skin_top"));
    CHECK(force < 1e-12);
    CHECK(moment < 1e-10);
  }
  CHECK(sliding > 10);
  CHECK(static_cast<double>(solution.cost.factorizations) <= 1.5 * solution.iterations);
}
