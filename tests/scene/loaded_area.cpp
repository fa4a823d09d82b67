// Loads on a part of a face whose edges no grid lines meet.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <numbers>

#include "accuracy/estimate/error_estimate.hpp"
#include "scene/run/body_mesh.hpp"
#include "scene/run/loaded_area.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace {

// a block of 8 x 3 x 8 mm in cubes of 1 mm, with a traction on a part of its top
SolveConfig loaded(const std::string& within, int cells = 8) {
  return test::config_of(fmt::format(
      "mesh:\n"
      "  geometry: {{block: {{origin: [-4, 0, -4], size: [8, 3, 8], divisions: [{0}, 4, {0}]}}}}\n"
      "  points: {{A: [0, 3, 0]}}\n"
      "  sets: {{patch: {{of: top, within: {1}}}}}\n"
      "material: {{matrix: {{neo_hooke: {{a1: 0.1}}}}, volume: {{quadratic: {{d: 0.1}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y, z]}}]\n"
      "loads: [{{on: patch, traction: {{y: -0.003}}}}]\n"
      "estimate: refinement\n"
      "path: {{steps: 1}}\n",
      cells, within));
}

std::string square(double half) {
  return fmt::format("{{box: {{from: [{0:g}, 2.9, {0:g}], to: [{1:g}, 3.1, {1:g}]}}}}", -half,
                     half);
}

std::vector<std::string> said_of(const SolveConfig& config) {
  return loads_on_other_areas(config, body_mesh(config, "", test::nowhere));
}

}  // namespace

TEST_CASE("a load acts on whole facets, and a box that they do not fill is named") {
  CHECK(said_of(loaded(square(2))).empty());
  const std::vector<std::string> said = said_of(loaded(square(1.7)));
  REQUIRE(said.size() == 1);
  CHECK(said[0].find("4 mm^2 of whole facets in \"patch\", which is 11.56 mm^2") !=
        std::string::npos);
  CHECK(said_of(loaded(square(9))).empty());  // beyond the face
  CHECK(said_of(loaded("{cylinder: {axis: y, radius: 2}}")).size() == 1);
  CHECK(said_of(loaded("{cylinder: {axis: x, through: [0, 3, 0], radius: 2}}"))
            .empty());  // nothing is known of it
  SolveConfig moved = loaded(square(1.7));
  moved.loads[0].traction.reset();
  moved.loads[0].displacement = Displacement{{}, HistoryConfig{-0.1}, {}};
  CHECK(said_of(moved).empty());
  const Mesh mesh = body_mesh(loaded(square(2)), "", test::nowhere);
  CHECK(area_of(mesh, "patch") == near(16));
  CHECK(area_of(mesh, "none") == 0);
}

TEST_CASE("meshes on which a loaded set has another area show no error") {
  const auto errors_of = [](const SolveConfig& config) {
    const SolvedPath itself = solved_path(config, config.material, test::nowhere);
    return estimate_along(config, config.material, test::nowhere, itself, 0);
  };
  const PathErrors other = errors_of(loaded(square(2)));
  CHECK(other.at_end.empty());
  REQUIRE(other.not_known.size() == 1);
  CHECK(other.not_known[0].find("\"patch\"") != std::string::npos);
  // 12 cells, and 8 and 6 of the coarser ones, have a line in the middle and at the sides
  const PathErrors whole = errors_of(loaded(square(9), 12));
  CHECK(!whole.at_end.empty());
  CHECK(whole.not_known.empty());
}
