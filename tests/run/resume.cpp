// A run continued from any of its steps gives the rest of them to the last bit: what a step starts
// from is in its record.
#include <doctest/doctest.h>

#include "support/solved_scene.hpp"

using namespace langer;

namespace {

const std::string yeoh =
    "{matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, volume: {quadratic: {d: 1.0e-5}}}\n";
const std::string skin =
    "{matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, fibres: [{hgo: {c1: 0.317, c2: 1.1}, alpha: 60}], "
    "volume: {quadratic: {d: 1.0e-5}}}\n";

std::string block(const std::string& cells, const std::string& divisions) {
  return "mesh:\n  geometry: {block: {size: [12, 4, 12], divisions: " + divisions +
         "}}\n  cells: " + cells +
         "\n  sets: {contact: {of: top, within: {cylinder: {axis: y, through: [6, 0, 6], radius: 3.1}}}}\n"
         "supports: [{on: bottom, hold: [x, y, z]}]\n";
}
std::string ball(const std::string& centre, const std::string& motion) {
  return "contacts: {ball: {on: contact, rigid: {sphere: {radius: 2.5, centre: " + centre +
         "}}, friction: 0.34, motion: " + motion + "}}\npath: {first: 0.1, largest: 0.1}\n";
}

bool same(const std::vector<Vec3>& a, const std::vector<Vec3>& b) { return a == b; }

// continued after steps 1, 3, ...
void check(const std::string& text) {
  CAPTURE(text);
  const SolveConfig config = test::config_of(text);
  const Mesh mesh = test::mesh_in(config);
  const Scene scene = make_scene(config, mesh, config.material, test::nowhere);
  const auto part = ReducedScene::find(config.symmetry, mesh, scene, test::nowhere);
  test::HowToSolve how{config.path, config.solver};
  const test::Solved whole = solved(mesh, scene, part, how);
  REQUIRE(whole.steps.size() >= 4);
  for (std::size_t at = 0; at + 1 < whole.steps.size(); at += 2) {
    CAPTURE(at);
    how.from = &whole.steps[at], how.before = at > 0 ? &whole.steps[at - 1] : nullptr;
    const test::Solved rest = solved(mesh, scene, part, how);
    REQUIRE(rest.steps.size() + at + 1 == whole.steps.size());
    for (std::size_t k = 0; k < rest.steps.size(); ++k) {
      const StepRecord &a = whole.steps[at + 1 + k], &b = rest.steps[k];
      CAPTURE(k);
      REQUIRE(a.iterations == b.iterations);
      REQUIRE(same(a.u, b.u));
      REQUIRE(same(a.reaction, b.reaction));
      REQUIRE(a.scalars == b.scalars);
      REQUIRE(a.cell_fields == b.cell_fields);
      for (const auto& [name, contact] : a.contacts)
        REQUIRE(same(contact.r, b.contacts.at(name).r));
    }
  }
}

}  // namespace

TEST_CASE("a continued run is the run: hex8, whole, half turn, quarter and pulled aside") {
  const std::string press = ball("[6, 6.5, 6]", "[{t: 1, to: [0, -0.6, 0]}]");
  check(block("hex8", "[8, 3, 8]") + "material: " + skin + press + "symmetry: none\n");
  check(block("hex8", "[8, 3, 8]") + "material: " + skin + press);
  check(block("hex8", "[8, 3, 8]") + "material: " + yeoh + press);
  check(block("hex8", "[8, 3, 8]") + "material: " + skin +
        ball("[6, 6.5, 6]", "[{t: 0.5, to: [0, -0.5, 0]}, {t: 1, to: [0.4, -0.5, 0.1]}]"));
}

TEST_CASE("a continued run is the run: hex27, whose cells are propped by their pressures") {
  const std::string press = ball("[6, 6.5, 6]", "[{t: 1, to: [0, -0.6, 0]}]");
  check(block("hex27", "[4, 2, 4]") + "material: " + skin + press);
  check(block("hex27", "[4, 2, 4]") + "material: " + yeoh + press);
}

TEST_CASE("a continued run is the run: sections") {
  for (const char* cells : {"hex8", "hex27"}) {
    const std::string sets =
        "\n  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 3.1}}}}\n";
    check(
        "mesh:\n  geometry: {section: {of: axisymmetric, size: [8, 4], divisions: [12, 5]}}\n  cells: " +
        std::string(cells) + sets + "supports: [{on: bottom, hold: [x, y, z]}]\nmaterial: " + yeoh +
        ball("[0, 6.5, 0]", "[{t: 1, to: [0, -0.6, 0]}]"));
    check(
        "mesh: {geometry: {section: {of: plane_strain, size: [4, 2], divisions: [6, 3]}}, cells: " +
        std::string(cells) +
        "}\nsupports: [{on: bottom, hold: [x, y]}]\nloads: [{on: top, displacement: {x: 0.4, y: -0.3}}]\nmaterial: " +
        yeoh);
  }
}

TEST_CASE(
    "a continued run is the run: KINSOL, the paper's pointwise dilatation, a pull along oblique fibres") {
  const std::string pull =
      "mesh: {geometry: {block: {size: [4, 2, 2], divisions: [6, 3, 3]}}}\nsupports: [{on: x_min, hold: [x, y, z]}]\n"
      "loads: [{on: x_max, displacement: {x: 0.8}}]\nmaterial: " +
      skin;
  check(pull + "solver: {kinsol: {strategy: newton}}\n");
  check(pull + "formulation: displacement\n");
  check(pull);
}
