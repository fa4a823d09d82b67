// Scenes of several bodies on the part that a symmetry leaves, against the same scenes as a whole.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "identification/inverse/sensitivity.hpp"
#include "mortar/bodies.hpp"

using namespace langer;
using namespace langer::test;

namespace body_symmetry_tests {

namespace {

std::string block(const std::string& origin, const std::string& size, const std::string& divisions,
                  double a1 = 0.05) {
  return "{mesh: {geometry: {block: {origin: " + origin + ", size: " + size +
         ", divisions: " + divisions +
         "}}}, material: {matrix: {neo_hooke: {a1: " + std::to_string(a1) +
         "}}, volume: {quadratic: {d: 0.5}}}}\n";
}

// Two bodies whose middles are both in x = 0 and z = 0.
const std::string skin_and_pad =
    "bodies:\n  skin: " + block("[-2, 0, -2]", "[4, 1, 4]", "[8, 2, 6]") +
    "  pad: " + block("[-1.1, 1, -0.9]", "[2.2, 1, 1.8]", "[6, 2, 8]") +
    "supports:\n  - {on: skin_bottom, hold: [x, y, z]}\n";

const std::string path =
    "path: {first: 0.25, largest: 0.25}\nsolver: {newton: {relative: 1.0e-9}}\n";

BodiesScene with_symmetry(const std::string& text, const std::string& choice) {
  return bodies_scene(text + "symmetry: " + choice + "\n");
}

// How many times the number of cells of the part all cells are.
double reduction_of(const BodiesScene& scene) {
  const Run run(scene.mesh, scene.config, scene.config.material, scene.where);
  return static_cast<double>(scene.mesh.n_cells()) / run.reduction.mesh().n_cells();
}

struct Distance {
  double apart = 0, size = 0;
  void add(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      apart = std::max(apart, (a[i] - b[i]).norm());
      size = std::max(size, b[i].norm());
    }
  }
  double relative() const { return apart / size; }
};

// Columns whose values do not depend on the part that is solved.
bool compares(const std::string& column) {
  for (const char* begins : {"force", "contact_area", "pressure_max", "penetration_", "energy",
                             "bonded_area", "adhesion", "work", "dissipated"})
    if (column.starts_with(begins)) return true;
  return false;
}

void check_same(const StepRecord& part, const StepRecord& whole, double tolerance) {
  Distance u, reaction;
  u.add(part.u, whole.u);
  reaction.add(part.reaction, whole.reaction);
  CHECK(u.relative() < tolerance);
  CHECK(reaction.relative() < tolerance);
  double largest = 0;
  for (const auto& [name, value] : whole.scalars)
    if (name.starts_with("force")) largest = std::max(largest, std::abs(value));
  for (const auto& [name, value] : whole.scalars) {
    if (!compares(name)) continue;
    const std::string shown = name;
    CAPTURE(shown);
    const double size = name.starts_with("force") ? largest : std::max(std::abs(value), 1e-3);
    CHECK(std::abs(part.scalars.at(name) - value) < tolerance * size);
  }
  REQUIRE(part.contacts.size() == whole.contacts.size());
  for (const auto& [name, contact] : whole.contacts) {
    const std::string shown = name;
    CAPTURE(shown);
    Distance r, pull;
    r.add(part.contacts.at(name).r, contact.r);
    pull.add(part.contacts.at(name).adhesive, contact.adhesive);
    CHECK(r.apart < tolerance * largest);
    CHECK(pull.apart <= tolerance * largest);
    for (std::size_t i = 0; i < contact.gap.size(); ++i)
      if (std::isfinite(contact.gap[i]))
        CHECK(std::abs(part.contacts.at(name).gap[i] - contact.gap[i]) < tolerance);
  }
}

// A facet is projected along its own normal. Next to a plane of symmetry this leads across it, by
// the slope of the facet times what is open between the facets, and the part has no facets there:
// it projects along the plane. On these coarse meshes that makes a difference of 1e-4.
constexpr double across_planes = 3e-4;

void check_part(const std::string& text, double times, double tolerance = across_planes) {
  const BodiesScene part = with_symmetry(text, "auto");
  const BodiesScene whole = with_symmetry(text, "none");
  CHECK(reduction_of(part) == times);
  CHECK(reduction_of(whole) == 1);
  const BodiesSolution of_part = solved(part);
  const BodiesSolution of_whole = solved(whole);
  REQUIRE(of_part.steps.size() == of_whole.steps.size());
  for (std::size_t i = 0; i < of_whole.steps.size(); ++i)
    check_same(of_part.steps[i], of_whole.steps[i], tolerance);
}

const std::string pressed = "loads: [{on: pad_top, displacement: {x: 0, y: -0.3, z: 0}}]\n";
const std::string drawn =
    "loads: [{on: pad_top, displacement: {x: [{t: 0.5, to: 0}, {t: 1, to: 0.2}], "
    "y: [{t: 0.5, to: -0.2}, {t: 1, to: -0.2}], z: 0}}]\n";
const std::string peeled =
    "loads: [{on: pad_top, displacement: {x: 0, y: [{t: 0.2, to: -0.02}, {t: 1, to: 0.06}], "
    "z: 0}}]\n";
const std::string rubs = "contacts: {pad: {on: pad_bottom, against: skin_top, friction: 0.2}}\n";
const std::string sticks =
    "contacts: {pad: {on: pad_bottom, against: skin_top, adhesion: {work: 2.0e-4, stiffness: 1, "
    "tangential: 0.5}}}\n";

}  // namespace

TEST_CASE("symmetry of bodies: facets that stay plane make no difference") {
  const std::string lines =
      ", sets: {along_x: {of: bottom, within: {cylinder: {axis: x, radius: 0.01}}}, "
      "along_z: {of: bottom, within: {cylinder: {axis: z, radius: 0.01}}}}}";
  std::string skin = block("[-1, 0, -1]", "[2, 1, 2]", "[8, 2, 6]");
  skin.replace(skin.find("}}}, material") + 2, 1, lines);
  check_part("bodies:\n  skin: " + skin +
                 "  pad: " + block("[-1, 1, -1]", "[2, 1, 2]", "[6, 2, 8]") +
                 "supports:\n  - {on: skin_bottom, hold: [y]}\n"
                 "  - {on: skin_along_x, hold: [z]}\n  - {on: skin_along_z, hold: [x]}\n"
                 "loads: [{on: pad_top, displacement: {y: -0.3}}]\n" +
                 rubs + path,
             4, 1e-9);
}

TEST_CASE("symmetry of bodies: a quarter of two that are pressed together with friction") {
  check_part(skin_and_pad + pressed + rubs + path, 4);
}

TEST_CASE("symmetry of bodies: a half of two that are drawn along each other") {
  check_part(skin_and_pad + drawn + rubs + path, 2);
}

TEST_CASE("symmetry of bodies: bonds that are peeled off") {
  check_part(skin_and_pad + peeled + sticks + path, 4);
}

TEST_CASE("symmetry of bodies: a traction, and an indenter that presses as well") {
  check_part(skin_and_pad +
                 "  - {on: pad_x_max, hold: [z]}\n  - {on: pad_x_min, hold: [z]}\n"
                 "loads: [{on: skin_top, pressure: 0.001}]\n"
                 "contacts:\n"
                 "  ball: {on: pad_top, friction: 0.3, rigid: {sphere: {radius: 3, centre: [0, 5, "
                 "0]}}, motion: [{t: 1, to: [0, -0.3, 0]}]}\n"
                 "  pad: {on: pad_bottom, against: skin_top, friction: 0.2}\n" +
                 path,
             4);
}

TEST_CASE("symmetry of bodies: a body that only friction holds") {
  check_part("bodies:\n  plate: " + block("[-2, 2, -2]", "[4, 1, 4]", "[4, 2, 4]") +
                 "  skin: " + block("[-2, 0, -2]", "[4, 1, 4]", "[4, 2, 4]") +
                 "  pad: " + block("[-1, 1, -1]", "[2, 1, 2]", "[4, 2, 4]") +
                 "supports: [{on: skin_bottom, hold: [x, y, z]}]\n"
                 "loads: [{on: plate_top, displacement: {x: 0.1, y: -0.3, z: 0}}]\n"
                 "contacts:\n"
                 "  below: {on: pad_bottom, against: skin_top, friction: 0.4}\n"
                 "  above: {on: pad_top, against: plate_bottom, friction: 0.4}\n" +
                 path,
             2);
}

TEST_CASE("symmetry of bodies: the law in the sparse tangent") {
  const std::string fine = "bodies:\n  skin: " + block("[-2, 0, -2]", "[4, 1, 4]", "[20, 1, 18]") +
                           "  pad: " + block("[-1.5, 1, -1.5]", "[3, 1, 3]", "[18, 1, 20]") +
                           "supports:\n  - {on: skin_bottom, hold: [x, y, z]}\n" + drawn + rubs +
                           path;
  const BodiesScene part = with_symmetry(fine, "auto");
  const Run run(part.mesh, part.config, part.config.material, part.where);
  CHECK(run.increment.bodies_in_tangent());
  check_part(fine, 2);
}

TEST_CASE("symmetry of bodies: a run that was killed goes on with the same digits") {
  for (const std::string& rest_of_it : {drawn + rubs, peeled + sticks}) {
    const BodiesScene scene = with_symmetry(skin_and_pad + rest_of_it + path, "auto");
    CHECK(reduction_of(scene) > 1);
    const BodiesSolution all = solved(scene);
    const std::size_t at = all.steps.size() - 2;
    const BodiesSolution rest = solved(scene, {}, &all.steps[at], &all.steps[at - 1]);
    REQUIRE(rest.steps.size() == 1);
    Distance u;
    u.add(rest.last().u, all.last().u);
    CHECK(u.apart == 0);
    CHECK(rest.last().scalars == all.last().scalars);
  }
}

TEST_CASE("symmetry of bodies: derivatives are those of the whole") {
  const std::string text =
      skin_and_pad + drawn + rubs + path +
      "sensitivity: [materials.pad.matrix.neo_hooke.a1, contacts.pad.friction]\n";
  std::vector<std::vector<StepRecord>> found;
  for (const char* choice : {"auto", "none"}) {
    const BodiesScene scene = with_symmetry(text, choice);
    Run run(scene.mesh, scene.config, scene.config.material, scene.where);
    CHECK((run.reduction.mesh().n_cells() < scene.mesh.n_cells()) == (choice[0] == 'a'));
    Sensitivity sensitivity(run, scene.config, scene.where);
    CHECK(run.follow(sensitivity.along({})).path.complete);
    found.push_back(sensitivity.now());
  }
  REQUIRE(found[0].size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    Distance u, reaction, r;
    u.add(found[0][i].u, found[1][i].u);
    reaction.add(found[0][i].reaction, found[1][i].reaction);
    r.add(found[0][i].contacts.at("pad").r, found[1][i].contacts.at("pad").r);
    CHECK(u.relative() < 5e-4);
    CHECK(reaction.relative() < 5e-4);
    CHECK(r.relative() < 5e-4);
    for (const char* k : {"x", "y", "z"}) {
      const std::string name = std::string("force_pad_") + k;
      CHECK(std::abs(found[0][i].scalars.at(name) - found[1][i].scalars.at(name)) <
            5e-4 * reaction.size);
    }
  }
}

TEST_CASE("symmetry of bodies: what is not symmetric is solved as a whole") {
  const std::string pad = "  pad: " + block("[-1, 1, -1]", "[2, 1, 2]", "[4, 2, 4]");
  const std::string held = "supports: [{on: skin_bottom, hold: [x, y, z]}]\n" + pressed;
  const auto times = [&](const std::string& skin, const std::string& contacts) {
    return reduction_of(
        with_symmetry("bodies:\n  skin: " + skin + pad + held + contacts + path, "auto"));
  };
  const std::string even = block("[-2, 0, -2]", "[4, 1, 4]", "[4, 2, 4]");
  CHECK(times(even, rubs) == 4);
  // cells across one plane, across both, a skin off the middle
  CHECK(times(block("[-2, 0, -2]", "[4, 1, 4]", "[5, 2, 4]"), rubs) == 2);
  CHECK(times(block("[-2, 0, -2]", "[4, 1, 4]", "[5, 2, 5]"), rubs) == 1);
  CHECK(times(block("[-2, 0, -2]", "[5, 1, 4]", "[5, 2, 4]"), rubs) == 2);
  // one pad side that may not touch
  CHECK(times(even,
              "contacts: {pad: {on: pad_bottom, against: skin_top}, side: {on: pad_x_max, against: "
              "skin_top}}\n") == 2);
}

TEST_CASE("symmetry of bodies: a symmetry that is not there is refused by what breaks it") {
  const std::string odd = "bodies:\n  skin: " + block("[-2, 0, -2]", "[4, 1, 4]", "[5, 2, 4]") +
                          "  pad: " + block("[-1, 1, -1]", "[2, 1, 2]", "[4, 2, 4]") +
                          "supports: [{on: skin_bottom, hold: [x, y, z]}]\n" + pressed + rubs +
                          path;
  const BodiesScene scene = with_symmetry(odd, "mirror_x");
  CHECK_THROWS_WITH_AS(reduction_of(scene), doctest::Contains("cells cross the plane"), Failure);
  CHECK_THROWS_WITH_AS(bodies_scene(odd + "symmetry: half_turn\n"), doctest::Contains("symmetry"),
                       Failure);
}

}  // namespace body_symmetry_tests
