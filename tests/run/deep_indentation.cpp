// Quadratic cells under high pressure.
#include <doctest/doctest.h>

#include "accuracy/estimate/error_estimate.hpp"
#include "core/config/tree.hpp"
#include "scene/model/solve_config_io.hpp"
#include "support/near.hpp"

using namespace langer;

// With a few shear moduli for what the modes leave of J - 1 cells buckle within themselves near the
// end of this path (solid.hpp).
TEST_CASE(
    "quadratic cells hold under a sphere pressed 44 % of the thickness into a stiffening body") {
  const std::string folder = std::string(SOURCE_DIR) + "/configs/solve";
  const std::string text = R"(
mesh:
  geometry: {indented_block: {origin: [-21, 0, -21], size: [42, 5.91, 42], radius: 4.35, depth: 2.6, edge: 0.5}}
  cells: hex27
  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 6.5}}}}
material: {matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, fibres: [], volume: {quadratic: {d: 1e-6}}}
supports: [{on: bottom, hold: [x, y, z]}]
contacts:
  sphere: {on: contact, rigid: {sphere: {radius: 4.35, centre: [0, 10.26, 0]}}, friction: 0.15, motion: [{t: 1, to: [0, -2.6, 0]}]}
path: {first: 0.1, largest: 0.1, smallest: 0.05}
symmetry: auto
)";
  const SolveConfig config =
      read_config<SolveConfig>(parse_yaml(text, folder + "/deep.yaml", folder)).config;
  const auto found =
      end_of_path(config, config.material, [](const std::string&) { return Place{}; });
  CHECK(found[0].value == near(186.1, 0.01));
}
