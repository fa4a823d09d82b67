// The unit of length and that of stress are the user's: a scene in other units takes the same
// iterations and gives the same results, in those units.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "support/solved_scene.hpp"

using namespace langer;

namespace {

struct Units {
  double length = 1, stress = 1;
};

std::string matrix_in(const Units& units) {
  return fmt::format(
      "material: {{matrix: {{yeoh: {{a1: {}, a2: {}}}}}, fibres: [{{hgo: {{c1: {}, c2: 1.2}}, "
      "alpha: 30}}], volume: {{quadratic: {{d: {}}}}}}}\n",
      0.2 * units.stress, 0.1 * units.stress, 0.05 * units.stress, 1e-2 / units.stress);
}

std::string block_in(const Units& units, const char* divisions) {
  const double l = units.length;
  return fmt::format(
      "mesh: {{geometry: {{block: {{origin: [{}, 0, {}], size: [{}, {}, {}], divisions: {}}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y, z]}}]\n",
      -6 * l, -6 * l, 12 * l, 4 * l, 12 * l, divisions);
}

std::string indentation(const Units& units) {
  const double l = units.length;
  return block_in(units, "[8, 3, 8]") + matrix_in(units) +
         fmt::format(
             "contacts: {{ball: {{on: top, rigid: {{sphere: {{radius: {}, centre: [0, {}, 0]}}}}, "
             "friction: 0.34, motion: [{{t: 0.6, to: [0, {}, 0]}}, {{t: 1, to: [{}, {}, 0]}}]}}}}\n"
             "path: {{first: 0.2, largest: 0.2}}\n",
             2.5 * l, 6.5 * l, -0.8 * l, 0.3 * l, -0.8 * l);
}

std::string long_steps(const Units& units) {  // of 1.5 thicknesses of the body each
  return block_in(units, "[4, 3, 4]") + matrix_in(units) +
         fmt::format("loads: [{{on: top, displacement: {{x: {}, y: {}}}}}]\npath: {{steps: 1}}\n",
                     2.5 * units.length, 1.5 * units.length);
}

std::string pressed(const Units& units) {
  return block_in(units, "[4, 3, 4]") + matrix_in(units) +
         fmt::format(
             "loads: [{{on: top, pressure: {}}}, {{on: x_max, traction: {{y: {}}}}}]\n"
             "path: {{steps: 3}}\n",
             0.1 * units.stress, 0.03 * units.stress);
}

struct Result {
  int iterations = 0;
  std::vector<StepRecord> steps;
};

Result solve(const std::string& text) {
  CAPTURE(text);
  const SolveConfig config = test::config_of(text);
  Run run(test::mesh_in(config), config, config.material, test::nowhere);
  Result result;
  RunListener listener;
  listener.of_whole = [&](StepRecord& step, const SolveReport&) {
    result.steps.push_back(step);
  };
  const RunEnd end = run.follow(listener);
  CAPTURE(end.path.why);
  REQUIRE(end.path.complete);
  CHECK(end.path.cut_backs == 0);
  result.iterations = end.path.iterations + end.path.again;
  return result;
}

double largest(const std::vector<Vec3>& all) {
  double most = 0;
  for (const Vec3& x : all) most = std::max(most, x.norm());
  return most;
}

// `scaled` less `scale` times `original`, over the largest of those
double difference(const std::vector<Vec3>& scaled, const std::vector<Vec3>& original,
                  double scale) {
  REQUIRE(scaled.size() == original.size());
  double most = 0;
  for (std::size_t i = 0; i < scaled.size(); ++i)
    most = std::max(most, (scaled[i] - scale * original[i]).norm());
  return most / (scale * largest(original));
}

}  // namespace

TEST_CASE(
    "a scene in other units of length and stress takes the same iterations to the same result") {
  for (const auto& scene : {indentation, long_steps, pressed}) {
    const Result in_mm = solve(scene({}));
    for (const Units& units :
         {Units{1e-3, 1}, {1e3, 1}, {1, 1e-3}, {1, 1e3}, {1e-3, 1e3}, {1e3, 1e-3}}) {
      CAPTURE(units.length);
      CAPTURE(units.stress);
      const Result other = solve(scene(units));
      CHECK(other.iterations == in_mm.iterations);
      REQUIRE(other.steps.size() == in_mm.steps.size());
      const double force = units.length * units.length * units.stress;
      for (std::size_t i = 0; i < other.steps.size(); ++i) {
        const StepRecord &a = other.steps[i], &b = in_mm.steps[i];
        CHECK(difference(a.u, b.u, units.length) < 1e-9);
        CHECK(difference(a.reaction, b.reaction, force) < 1e-9);
      }
    }
  }
}

TEST_CASE("solver.newton.largest_move of a config is a length in mm") {
  const Result free = solve(long_steps({}));
  const Result limited = solve(long_steps({}) + "solver: {newton: {largest_move: 0.3}}\n");
  CHECK(limited.iterations >= 9);  // 2.5 mm in steps of 0.3 mm
  CHECK(free.iterations < limited.iterations);
  CHECK(difference(limited.steps.back().reaction, free.steps.back().reaction, 1) < 1e-6);
}
