// A block drawn over a curved one: forces without the saw-tooth that node-to-facet contact has.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "mortar/bodies.hpp"
#include "support/near.hpp"

using namespace langer;
using namespace langer::test;

namespace {

// greatest deviation of a force from its mean over one facet, relative
struct Ripple {
  double along = 0;
  double across = 0;
};

constexpr std::size_t per_facet = 6;  // increments

// A soft block on a stiff arch in plane strain: pressed on it, then drawn by four of its facets of
// 0.5 mm.
Ripple ironed(const std::string& on, const std::string& against) {
  const std::string text =
      "bodies:\n"
      "  die:\n"
      "    mesh: {geometry: {block: {origin: [-2, 0, 0], size: [4, 1, 0.3], divisions: [11, 2, 1]}}, "
      "bend: 3}\n"
      "    material: {matrix: {neo_hooke: {a1: 1}}, volume: {quadratic: {d: 0.5}}}\n"
      "  slab:\n"
      "    mesh: {geometry: {block: {origin: [-4, 1, 0], size: [8, 1.5, 0.3], divisions: [16, 3, 1]}}}\n"
      "    material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.5}}}\n"
      "supports:\n"
      "  - {on: die_bottom, hold: [x, y, z]}\n"
      "  - {on: die_z_min, hold: [z]}\n"
      "  - {on: die_z_max, hold: [z]}\n"
      "  - {on: slab_z_min, hold: [z]}\n"
      "  - {on: slab_z_max, hold: [z]}\n"
      "loads:\n"
      "  - {on: slab_top, displacement: {x: [{t: 0.2, to: 0}, {t: 1, to: 2}], y: [{t: 0.2, to: "
      "-0.3}, {t: 1, to: -0.3}]}}\n"
      "contacts: {iron: {on: " +
      on + ", against: " + against +
      ", friction: 0.3}}\n"
      "path: {first: 0.0333333333333333333, largest: 0.0333333333333333333}\n";
  const BodiesScene scene = bodies_scene(text);
  const BodiesSolution solution = solved(scene);
  std::vector<double> along, across;
  for (const StepRecord& step : solution.steps) {
    if (step.t < 0.4) continue;  // sliding all over
    along.push_back(step.scalars.at("force_iron_x"));
    across.push_back(step.scalars.at("force_iron_y"));
  }
  REQUIRE(along.size() > 2 * per_facet);
  const auto ripple = [](const std::vector<double>& f) {
    double most = 0;
    for (std::size_t i = 0; i + per_facet < f.size(); ++i) {
      double mean = 0.5 * (f[i] + f[i + per_facet]);
      for (std::size_t k = 1; k < per_facet; ++k) mean += f[i + k];
      mean /= static_cast<double>(per_facet);
      most = std::max(most, std::abs(f[i + per_facet / 2] / mean - 1));
    }
    return most;
  };
  return {ripple(along), ripple(across)};
}

}  // namespace

TEST_CASE("the forces of ironing have no saw-tooth, whichever surface the law holds on") {
  for (const auto& [on, against] :
       {std::pair{"slab_bottom", "die_top"}, std::pair{"die_top", "slab_bottom"}}) {
    const auto shown = on;
    CAPTURE(shown);
    const Ripple ripple = ironed(on, against);
    CHECK(ripple.along < 0.02);
    CHECK(ripple.across < 0.02);
  }
}
