// A solution turned into that of a scene with other fibre angles is what solving that scene gives.
#include "scene/run/mirrored_solution.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include "scene/run/cell_stress.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace mirrored_solution_tests {

using test::config_of, test::largest_difference, test::mesh_in, test::nowhere;

namespace {

struct Case {
  double alpha = 25;  // [deg]
  int nx = 6, nz = 6;
  double x = 0, z = 0;  // of the ball's centre
};

SolveConfig scene(const Case& c) {
  return config_of(fmt::format(
      "mesh:\n  geometry: {{block: {{origin: [-3, 0, -3], size: [6, 3, 6], divisions: [{}, 2, {}]}}}}\n"
      "  sets: {{contact: {{of: top, within: {{cylinder: {{axis: y, radius: 2.6}}}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y, z]}}]\n"
      "contacts: {{ball: {{on: contact, rigid: {{sphere: {{radius: 3, centre: [{}, 6, {}]}}}}, friction: 0.3, "
      "motion: [{{t: 1, to: [0, -0.4, 0]}}]}}}}\n"
      "fibre_angles: [{}]\nmaterial: {{matrix: {{yeoh: {{a1: 0.1, a2: 0.1, a3: 0.1}}}}, "
      "fibres: [{{hgo: {{c1: 0.3, c2: 0.5}}, alpha: 0}}], volume: {{quadratic: {{d: 1e-3}}}}}}\n"
      "symmetry: none\npath: {{first: 0.5, largest: 0.5}}\nsolver: {{newton: {{relative: 1e-11}}}}\n",
      c.nx, c.nz, c.x, c.z, c.alpha));
}

struct Pair {
  Mesh mesh;
  Scene one, other;
  std::string why;
  std::optional<MirrorOperation> operation;
  Pair(const Case& c, double beta) : mesh(mesh_in(scene(c))) {
    Case d = c;
    d.alpha = beta;
    const SolveConfig a = scene(c), b = scene(d);
    one = make_scene(a, mesh, a.material, nowhere),
    other = make_scene(b, mesh, b.material, nowhere);
    operation = operation_between(mesh, one, other, why);
  }
};

}  // namespace

TEST_CASE(
    "the image of a solution is the solution of the image: 180 - alpha, 90 - alpha, 90 + alpha and the same fibres") {
  const SolveConfig config = scene({});
  std::optional<test::Solved> solved;
  for (const auto& [beta, name] : {std::pair(155.0, "mirror x of"),
                                   {-25.0, "mirror x of"},
                                   {65.0, "mirror x = z of"},
                                   {115.0, "quarter turn about y of"},
                                   {205.0, "the same fibres as"}}) {
    const double angle = beta;
    CAPTURE(angle);
    const Pair pair({}, beta);
    REQUIRE(pair.operation.has_value());
    CHECK(pair.operation->name == name);
    const test::HowToSolve how{config.path, config.solver};
    if (!solved) solved = test::solved(pair.mesh, pair.one, std::nullopt, how);
    StepRecord one = solved->last(),
               own = test::solved(pair.mesh, pair.other, std::nullopt, how).last();
    CellStressRecorder(pair.mesh, pair.one, CellStress::tensor).add(one);
    CellStressRecorder(pair.mesh, pair.other, CellStress::tensor).add(own);
    const StepRecord image = image_of_step(one, pair.operation->symmetry, pair.other.contacts);
    CHECK(largest_difference(image.u, own.u) < 1e-8);
    CHECK(largest_difference(image.reaction, own.reaction) < 1e-8);
    CHECK((image.force_ind - own.force_ind).norm() < 1e-8);
    CHECK(largest_difference(image.contacts.at("ball").r, own.contacts.at("ball").r) < 1e-8);
    CHECK(image.contacts.at("ball").status == own.contacts.at("ball").status);
    for (const auto& [field, values] : own.cell_fields) {
      double largest = 0;
      for (const double value : values) largest = std::max(largest, std::abs(value));
      for (std::size_t e = 0; e < values.size(); ++e)
        CHECK(image.cell_fields.at(field)[e] ==
              near(values[e], 1e-7, field == "stress" ? 1e-7 * largest : 0));
    }
    CHECK(largest_difference(solved->last().u, own.u) >
          (beta == 205 ? -1 : 1e-3));  // something was turned
  }
}

TEST_CASE("what no mirror and no turn takes there is not an image, and it is said why") {
  CHECK_FALSE(Pair({}, 40).operation);
  CHECK(Pair({}, 40).why.find("fibres") != std::string::npos);
  CHECK_FALSE(Pair({.nx = 6, .nz = 4}, 65).operation);  // not square
  CHECK(Pair({.nx = 6, .nz = 4}, 155).operation);
  CHECK(Pair({.x = 0.3}, 155).operation->name == "mirror z of");
  CHECK_FALSE(Pair({.x = 0.3}, 65).operation);
  CHECK(Pair({.x = 0.3, .z = 0.3}, 65).operation->name == "mirror x = z of");
  CHECK_FALSE(Pair({.x = 0.3, .z = 0.1}, 155).operation);
  CHECK(Pair({.x = 0.3, .z = 0.1}, 155).why.find("ball") != std::string::npos);
}

}  // namespace mirrored_solution_tests
