// Error bars of contact between deformable bodies: the distance to a finer mesh is within them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "accuracy/estimate/error_estimate.hpp"
#include "accuracy/estimate/pad_edges.hpp"
#include "accuracy/refinement/accuracy.hpp"
#include "mortar/bodies.hpp"

using namespace langer;
using namespace langer::test;

namespace {

// Divisions in units of `n` of a layer and of a pad on it.
std::string pad_on_layer(int n, const std::string& move, const std::string& friction) {
  const auto divisions = [n](int x, int y, int z) {
    return "[" + std::to_string(x * n) + ", " + std::to_string(y * n) + ", " +
           std::to_string(z * n) + "]";
  };
  return "bodies:\n"
         "  skin:\n"
         "    mesh: {geometry: {block: {size: [4, 1, 4], divisions: " +
         divisions(4, 2, 4) +
         "}}}\n"
         "    material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.5}}}\n"
         "  pad:\n"
         "    mesh: {geometry: {block: {origin: [1, 1, 1], size: [2, 1, 2], divisions: " +
         divisions(2, 2, 2) +
         "}}}\n"
         "    material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.5}}}\n"
         "supports: [{on: skin_bottom, hold: [x, y, z]}]\n"
         "loads: [{on: pad_top, displacement: " +
         move +
         "}]\n"
         "contacts: {pad: {on: pad_bottom, against: skin_top, friction: " +
         friction +
         "}}\n"
         "path: {first: 0.25, largest: 0.25}\nestimate: refinement\n";
}

double value_of(const std::vector<Valued>& found, const std::string& name) {
  for (const Valued& one : found)
    if (one.name == name) return one.value;
  FAIL(name);
  return 0;
}

void check(const std::string& move, const std::string& friction) {
  CAPTURE(move);
  const BodiesScene scene = bodies_scene(pad_on_layer(2, move, friction));
  const BodiesScene finer = bodies_scene(pad_on_layer(4, move, friction));
  const SolvedPath solved = solved_path(scene.config, {}, scene.where, {});
  const auto errors = estimate_along(scene.config, {}, scene.where, solved, 1e-10, {}).at_end;
  const std::vector<Valued> fine = end_of_path(finer.config, {}, finer.where, {});
  int judged = 0;
  for (const ErrorEstimate& e : errors) {
    if (e.of.name != "force_pad" && e.of.name != "reaction_pad_top") continue;
    ++judged;
    const double off = std::abs(e.of.value - value_of(fine, e.of.name));
    MESSAGE(in_words(e) << "; a mesh twice as fine is " << off << " N away");
    CHECK(off < e.total());
    CHECK(e.total() < 0.25 * e.of.value);
  }
  CHECK(judged == 2);
}

}  // namespace

namespace {

// A pad of 4 mm on a layer of 6 mm, whose cells the edges of the pad do not meet.
std::string pad_between_lines(int layer, int pad, double stiffness, const std::string& more) {
  const auto divisions = [](int n) {
    const std::string along = std::to_string(n);
    return "[" + along + ", 4, " + along + "]";
  };
  return "bodies:\n"
         "  low: {mesh: {geometry: {block: {size: [6, 3, 6], divisions: " +
         divisions(layer) +
         "}}}, material: {matrix: {neo_hooke: {a1: 0.02}}, volume: {quadratic: {d: 1.0e-2}}}}\n"
         "  up: {mesh: {geometry: {block: {origin: [1, 3, 1], size: [4, 3, 4], divisions: " +
         divisions(pad) + "}}}, material: {matrix: {neo_hooke: {a1: " + std::to_string(stiffness) +
         "}}, volume: {quadratic: {d: 1.0e-2}}}}\n"
         "supports: [{on: low_bottom, hold: [x, y, z]}]\n"
         "loads: [{on: up_top, displacement: {x: 0, y: -0.5, z: 0}}]\n"
         "contacts: {c: {on: up_bottom, against: low_top}}\n"
         "path: {steps: 2}\nstability: off\n" +
         more;
}

}  // namespace

TEST_CASE("the edge of a pad between grid lines makes the bar longer, also where meshes agree") {
  for (const double stiffness : {0.05, 2.0}) {
    CAPTURE(stiffness);
    const BodiesScene scene =
        bodies_scene(pad_between_lines(8, 8, stiffness, "estimate: refinement\n"));
    const BodiesScene finer = bodies_scene(pad_between_lines(24, 16, stiffness, ""));
    CHECK(beside_pads(scene.config) > 0.05);
    CHECK(beside_pads(finer.config) == 0);  // lines at the edges of all three meshes
    const SolvedPath solved = solved_path(scene.config, {}, scene.where, {});
    const auto errors = estimate_along(scene.config, {}, scene.where, solved, 1e-10, {}).at_end;
    const double fine = value_of(end_of_path(finer.config, {}, finer.where, {}), "force_c");
    int judged = 0;
    for (const ErrorEstimate& e : errors) {
      if (e.of.name != "force_c" && e.of.name != "reaction_up_top") continue;
      ++judged;
      CHECK(e.order <= 1);
      CHECK(std::abs(e.of.value - fine) < e.total());
    }
    CHECK(judged == 2);
  }
}

TEST_CASE("an accuracy puts grid lines along the edges of a pad") {
  BodiesScene scene = bodies_scene(pad_between_lines(8, 8, 0.05, "accuracy: 5%\n"));
  const auto chosen = choose_accuracy(scene.config, {});
  REQUIRE(chosen);
  put(*chosen, scene.config);
  const Block& low = std::get<Block>(scene.config.bodies.at("low").mesh.geometry);
  REQUIRE(low.family);
  CHECK(low.family->breaks[0] == std::vector<double>{1, 5});
  CHECK(low.family->breaks[1].empty());
  CHECK(low.family->breaks[2] == std::vector<double>{1, 5});
  CHECK(beside_pads(scene.config) == 0);
  std::vector<std::string> notes;
  const Mesh mesh = mesh_of(low, {}, notes);
  for (const double x : {1.0, 5.0})
    CHECK(std::ranges::any_of(mesh.X, [x](const Vec3& at) { return at[0] == x; }));
}

TEST_CASE("the bar of a force between two bodies holds a mesh twice as fine") {
  check("{x: 0, y: -0.2, z: 0}", "0");
  check("{x: 0.2, y: -0.2, z: 0}", "0.3");
}
