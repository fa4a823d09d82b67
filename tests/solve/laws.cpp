// Every fibre law with every law of volume change: a cube under tension is the homogeneous state,
// in each formulation.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <map>

#include "mechanics/material/uniaxial.hpp"
#include "support/block.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;
using test::config_of, test::nowhere;

namespace {

const std::vector<std::string> fibre_laws{"hgo: {c1: 0.3, c2: 0.8}",
                                          "exp_pow: {ksi: 0.4, alpha: 0.5, beta: 2.5}",
                                          "pow_linear: {E: 1.5, lam0: 1.08, beta: 3}"};
std::vector<std::string> volume_laws(double bulk_modulus) {
  return {fmt::format("quadratic: {{d: {}}}", 2 / bulk_modulus),
          fmt::format("logarithmic: {{bulk_modulus: {}}}", bulk_modulus),
          fmt::format("simo_taylor: {{bulk_modulus: {}}}", bulk_modulus)};
}

}  // namespace

TEST_CASE("A pulled cube of any fibre law and any volume law is in the homogeneous state") {
  const Mesh small = test::cube(2);
  for (double bulk : {3., 2e5})
    for (const std::string& fibre : fibre_laws)
      for (const std::string& volume : volume_laws(bulk))
        for (const char* formulation : {"mean_dilatation", "displacement"}) {
          const std::string text = fmt::format(
              "material: {{matrix: {{neo_hooke: {{a1: 0.05}}}}, fibres: [{{{}}}], volume: {{{}}}}}\n"
              "formulation: {}\nsupports: [{{on: x_min, hold: [x]}}, {{on: y_min, hold: [y]}}, {{on: z_min, hold: [z]}}]\n"
              "loads: [{{on: x_max, displacement: {{x: 0.3}}}}]\npath: {{steps: 2}}\nsolver: {{newton: {{relative: 1.0e-10}}}}\n",
              fibre, volume, formulation);
          CAPTURE(text);
          const SolveConfig config = config_of(text);
          const Scene scene = make_scene(config, small, config.material, nowhere);
          const StepRecord last =
              test::solved(small, scene, std::nullopt, {config.path, config.solver}).steps.back();
          double force = 0;
          for (int n : small.node_sets.at("x_max")) force += last.reaction[n][0];
          const double length = small.X[small.node_sets.at("x_max")[0]][0],
                       stretch = 1 + 0.3 / length;
          const Uniaxial exact = uniaxial(*config.material, stretch);
          REQUIRE(exact.converged);
          CHECK(force ==
                near(exact.sigma * (1 + exact.J_minus_1) / stretch * length * length, 1e-7));
        }
}

TEST_CASE(
    "Cells of second order take the same increments with any volume law, and differ by what the laws do") {
  std::map<std::string, double> found;  // force
  for (const std::string& volume : volume_laws(2e4)) {
    const SolveConfig config = config_of(fmt::format(
        "mesh: {{geometry: {{block: {{size: [4, 2, 4], divisions: [3, 2, 3]}}}}, cells: hex27}}\n"
        "material: {{matrix: {{neo_hooke: {{a1: 0.1}}}}, fibres: [{{exp_pow: {{ksi: 0.1, alpha: 0.3, beta: 2.5}}, alpha: 30}}], "
        "volume: {{{}}}}}\n"
        "supports: [{{on: y_min, hold: [x, y, z]}}]\nloads: [{{on: y_max, displacement: {{y: -0.3, x: 0.2}}}}]\npath: {{steps: "
        "3}}\n",
        volume));
    const Mesh mesh = test::mesh_in(config);
    const Scene scene = make_scene(config, mesh, config.material, nowhere);
    const test::Solved solved =
        test::solved(mesh, scene, std::nullopt, {config.path, config.solver});
    REQUIRE(solved.steps.size() == 3);
    double force = 0;
    for (int n : mesh.node_sets.at("y_max")) force += solved.last().reaction[n][1];
    found[volume.substr(0, volume.find(':'))] = force;
  }
  for (const auto& [law, force] : found) {
    const auto of_law = law;
    CAPTURE(of_law);
    CHECK(force == near(found.at("quadratic"), 1e-3));
  }
}
