// Error bars of contact between deformable bodies: the distance to a finer mesh is within them.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "accuracy/estimate/error_estimate.hpp"
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

TEST_CASE("the bar of a force between two bodies holds a mesh twice as fine") {
  check("{x: 0, y: -0.2, z: 0}", "0");
  check("{x: 0.2, y: -0.2, z: 0}", "0.3");
}
