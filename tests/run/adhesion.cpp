// Indenters that adhere: a flat punch in closed form, a jump, a sphere that is pulled off, and what
// is kept of an earlier run.
#include <doctest/doctest.h>

#include <cmath>

#include "results/post/energy_columns.hpp"
#include "scene/run/post_files.hpp"
#include "support/near.hpp"
#include "support/section.hpp"

using namespace langer;

namespace {

// a plate glued to the top of a block that it may pull at: the same everywhere
std::string plate(const std::string& adhesion, const std::string& motion,
                  const std::string& more = "") {
  return "mesh: {geometry: {block: {size: [2, 1, 2], divisions: [2, 1, 2]}}, cells: hex8}\n"
         "material: {matrix: {neo_hooke: {a1: 50}}, volume: {quadratic: {d: 0.02}}}\n"
         "supports: [{on: bottom, hold: [y]}, {on: x_min, hold: [x]}, {on: x_max, hold: [x]}, {on: z_min, hold: [z]}, {on: z_max, "
         "hold: [z]}]\n"
         "contacts: {plate: {on: top, adhesion: " +
         adhesion + ", rigid: {plane: {point: [0, 1, 0], normal: [0, -1, 0]}}, motion: " + motion +
         "}}\n" + more;
}
constexpr double area = 4, stiffness = 100 + 4.0 / 3 * 100;  // of the block against stretch along
                                                             // y: 2/d + 4/3 mu, mu = 2 a1 [MPa]

std::vector<PathSums> sums_of(const test::Ended& found) {
  EnergyPath path(found.mesh, found.scene.contacts);
  StepRecord rest;
  rest.u.assign(found.mesh.X.size(), Vec3::Zero()), rest.reaction = rest.u;
  path.add(energy_state(rest, found.scene.contacts, {}));
  for (const StepRecord& step : found.steps) path.add(energy_state(step, found.scene.contacts, {}));
  return path.sums();
}

const std::string ball_off =
    "mesh:\n  geometry: {indented_disc: {size: [6, 5], radius: 5, depth: 0.06, edge: 0.08}}\n"
    "  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 1}}}}\n"
    "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.02}}}\nsupports: [{on: bottom, hold: [x, y]}]\n";
std::string pulled(const std::string& more) {
  return ball_off +
         "contacts: {ball: {on: contact, rigid: {sphere: {radius: 5, centre: [0, 10, 0]}}, " +
         more +
         "motion: [{t: 0.3, to: [0, -0.06, 0]}, {t: 1, to: [0, 0.14, 0]}]}}\npath: {first: 0.1, largest: 0.1}\nsolver: {newton: {iterations: 12}}\n";
}

}  // namespace

TEST_CASE("adhesion: a plate pulled off a stiff block bears what its bonds do and takes w A") {
  const test::Ended found = test::run(
      plate("{work: 0.02, stiffness: 20}", "[{t: 1, to: [0, 0.5, 0]}]", "path: {steps: 400}\n"));
  double most = 0;
  const double g_0 = std::sqrt(0.02 / 20);
  for (const StepRecord& step : found.steps) {
    const ContactRecord& plate = step.contacts.at("plate");
    const double g = plate.gap[0], traction = g < g_0 ? 20 * g : 0.02 * 0.02 / (20 * g * g * g);
    CAPTURE(g);
    CHECK(-step.force_ind[1] == near(area * traction, 1e-6));
    most = std::max(most, -step.force_ind[1]);
  }
  CHECK(most == near(area * std::sqrt(0.02 * 20), 0.02));
  const StepRecord& last = found.last();
  CHECK(last.scalars.at("energy_released") == 0);
  const double g = last.contacts.at("plate").gap[0];
  CHECK(last.scalars.at("adhesion_dissipated") ==
        near(0.02 * area * (1 - 0.02 / (20 * g * g)), 1e-6));
  CHECK(std::abs(sums_of(found).back().balance) < 1e-3);
  CHECK(sums_of(found).back().pull_off == near(most));
}

TEST_CASE(
    "adhesion: a plate on a long spring jumps off, and the energy that the jump releases is told") {
  // softening of the bonds beyond the stiffness of what pulls: the jump comes at most where 3 C
  // beta^2 A = k
  const std::string soft =
      plate("{work: 0.02, stiffness: 2000}", "[{t: 1, to: [0, 0.1, 0]}]", "path: {steps: 50}\n");
  const test::Ended found = test::run(soft);
  const StepRecord& last = found.last();
  const double sigma = std::sqrt(0.02 * 2000), taken = 0.02 * area;
  CHECK(last.scalars.at("adhesion_dissipated") == near(taken, 0.01));
  // just before, the block held sigma^2/(2 k) per volume of 1 mm height, and the bonds w/2; of that
  // w is taken
  const double held = area * (0.5 * sigma * sigma / stiffness + 0.5 * 0.02);
  CHECK(last.scalars.at("energy_released") == near(held - taken, 0.1));
  CHECK(std::abs(last.force_ind[1]) < 0.01 * area * sigma);
  CHECK(std::abs(sums_of(found).back().balance) < 1e-3);
}

TEST_CASE(
    "adhesion: a sphere pulled off a soft body, near to JKR though bonds are long and cells coarse") {
  const std::string adheres = "adhesion: {work: 5.0e-4, stiffness: 1.5}, ";
  const test::Ended found = test::run(pulled(adheres));
  double pull = 0;
  for (const StepRecord& step : found.steps) pull = std::max(pull, -step.force_ind[1]);
  const double jkr = 1.5 * std::acos(-1.0) * 5e-4 * 5;
  CHECK(pull == near(jkr,
                     0.15));  // cells and bonds that are coarse and long: docs/adhesion.md
  CHECK(std::abs(sums_of(found).back().balance) < 2e-3);
  CHECK(sums_of(found).back().pull_off == near(pull));  // what points away from the axis is no pull
  for (const Vec3& r : found.last().contacts.at("ball").r) CHECK(r.isZero(0));
}

TEST_CASE(
    "adhesion: a sphere is pulled off as hard as off a half-space that boundary elements know") {
  // python3 tests/peers/half_space.py 1.5 0.57: the radius that is touched at a depth of 0.06 mm
  constexpr double half_space = 0.01132;
  std::string scene = pulled("adhesion: {work: 5.0e-4, stiffness: 1.5}, ");
  const auto put = [&](const std::string& old, const std::string& text) {
    scene.replace(scene.find(old), old.size(), text);
  };
  put("size: [6, 5]", "size: [9, 6]"), put("edge: 0.08", "edge: 0.02"),
      put("centre: [0, 10, 0]", "centre: [0, 11, 0]");
  put("d: 0.02", "d: 0.001"), put("[0, 0.14, 0]", "[0, 0.02, 0]");
  double pull = 0;
  for (const StepRecord& step : test::run(scene).steps) pull = std::max(pull, -step.force_ind[1]);
  CHECK(pull == near(half_space, 0.02));
}

TEST_CASE("adhesion: the greatest pull is found on whichever indenter adheres") {
  const std::string alone =
      plate("{work: 0.02, stiffness: 20}", "[{t: 1, to: [0, 0.1, 0]}]", "path: {steps: 200}\n");
  std::string beside = alone;
  beside.replace(beside.find("{plate:"), 7,
                 "{aside: {on: x_max, rigid: {plane: {point: [3, 0, 0], normal: [-1, 0, 0]}}, "
                 "motion: [{t: 1, to: [0, 0.1, 0]}]}, plate:");
  const double pull = sums_of(test::run(alone)).back().pull_off;
  CHECK(pull == near(area * std::sqrt(0.02 * 20), 0.02));
  CHECK(sums_of(test::run(beside)).back().pull_off == near(pull, 1e-9));
}

TEST_CASE("adhesion: work 0 is no adhesion, bit for bit") {
  const test::Ended none = test::run(pulled("friction: 0.3, ")),
                    zero = test::run(pulled("friction: 0.3, adhesion: {work: 0, stiffness: 5}, "));
  REQUIRE(none.steps.size() == zero.steps.size());
  for (std::size_t i = 0; i < none.steps.size(); ++i) {
    CHECK(none.steps[i].u == zero.steps[i].u);
    CHECK(none.steps[i].scalars == zero.steps[i].scalars);
  }
}

TEST_CASE("adhesion: a continued run is the run") {
  const SolveConfig config = test::config_of(
      pulled("friction: 0.2, adhesion: {work: 5.0e-4, stiffness: 1.5, tangential: 1}, "));
  const Mesh mesh = test::mesh_in(config);
  const Scene scene = make_scene(config, mesh, config.material, test::nowhere);
  const auto part = ReducedScene::find(config.symmetry, mesh, scene, test::nowhere);
  test::HowToSolve how{config.path, config.solver};
  const test::Solved whole = solved(mesh, scene, part, how);
  for (std::size_t at : {whole.steps.size() / 4, whole.steps.size() / 2, whole.steps.size() - 3}) {
    how.from = &whole.steps[at], how.before = &whole.steps[at - 1];
    const test::Solved rest = solved(mesh, scene, part, how);
    REQUIRE(rest.steps.size() + at + 1 == whole.steps.size());
    CHECK(rest.last().u == whole.last().u);
    CHECK(rest.last().scalars == whole.last().scalars);
  }
}
