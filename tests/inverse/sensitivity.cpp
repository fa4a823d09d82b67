// Derivatives of whole runs, as a config asks for them, against central differences of runs with
// other numbers.
#include "identification/inverse/sensitivity.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "mechanics/material/parameters.hpp"
#include "scene/run/impact_results.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace sensitivity_tests {

namespace {

const std::string skin =
    "{matrix: {yeoh: {a1: 0.05, a2: 0.05, a3: 0.02}}, fibres: [{hgo: {c1: 0.1, c2: 0.3}, alpha: 30, switch: \"off\"}], volume: "
    "{quadratic: {d: 1.0e-3}}}\n";  // a difference over the switch of the fibres is none of a
                                    // derivative
const std::string fat =
    "{matrix: {yeoh: {a1: 0.02, a2: 0.05}}, volume: {quadratic: {d: 1.0e-3}}}\n";

std::string block(const std::string& cells, const std::string& divisions,
                  const std::string& more = "") {
  return "mesh:\n  geometry: {block: {origin: [-4, 0, -4], size: [8, 3, 8], divisions: " +
         divisions + "}}\n  cells: " + cells +
         "\n  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 2.4}}}}\n" + more +
         "supports: [{on: bottom, hold: [x, y, z]}]\n";
}
std::string ball(double friction, const std::string& motion = "[{t: 1, to: [0, -0.6, 0]}]") {
  return "contacts: {ball: {on: contact, rigid: {sphere: {radius: 2.5, centre: [0, 5.5, 0]}}, friction: " +
         std::to_string(friction) + ", motion: " + motion + "}}\n";
}
const std::string four =
    "path: {steps: 4}\nsolver: {newton: {relative: 1.0e-12}}\nstability: off\n";

std::string listed(const std::vector<std::string>& keys) {
  std::string list;
  for (const std::string& key : keys) list += (list.empty() ? "" : ", ") + ("\"" + key + "\"");
  return "sensitivity: [" + list + "]\n";
}

// Shapes and thicknesses without the functions under test: a sphere that keeps its lowest point, a
// block that is meshed anew below its top.
bool change_geometry(SolveConfig& config, const std::string& key, double by) {
  if (key.ends_with("sphere.radius")) {
    auto& sphere = std::get<Sphere>(*config.contacts.at("ball").rigid);
    sphere.radius += by;
    sphere.centre[1] += by;
    return true;
  }
  if (key.ends_with("cylinder.radius")) {
    std::get<Cylinder>(*config.contacts.at("ball").rigid).radius += by;
    return true;
  }
  if (!key.starts_with("mesh.")) return false;
  auto& block = std::get<Block>(config.mesh->geometry);
  block.size[1] += by;
  block.origin[1] -= by;
  if (key == "mesh.bodies[0].thickness") config.mesh->bodies[0].thickness += by;
  if (key == "mesh.bodies[1].thickness") config.mesh->bodies[1].thickness += by;
  return true;
}

// the number of a config; its own material or that of a body
void change(SolveConfig& config, const std::string& key, double by) {
  if (change_geometry(config, key, by)) return;
  if (key.starts_with("loads[") || key.ends_with("control.force") ||
      key.find(".adhesion.") != std::string::npos) {
    config = with_config_number(config, key, *config_number(config, key) + by);
    return;
  }
  if (key.starts_with("contacts.")) {
    for (auto& [name, contact] : config.contacts)
      if (key == "contacts." + name + ".friction") contact.friction += by;
    return;
  }
  Material* material = &*config.material;
  std::string rest = key;
  for (auto& [name, body] : config.materials)
    if (key.starts_with("materials." + name + "."))
      material = &*body.material, rest = key.substr(11 + name.size());
  for (const MaterialParameter& p : parameters(*material))
    if (p.key == rest) *p.value += by;
}

// The same scene where a number is more by h, and less.
struct Varied {
  SolveConfig more, less;
};
Varied varied(const SolveConfig& config, const std::string& key, double h) {
  Varied out{config, config};
  change(out.more, key, h);
  change(out.less, key, -h);
  return out;
}

double value_of(const SolveConfig& config, const std::string& key) {
  SolveConfig other = config;
  if (const auto value = config_number(config, key);
      value && key.find("friction") == std::string::npos)
    return *value;
  if (key.starts_with("contacts.")) return 0.3;
  for (auto& [name, body] : other.materials)
    if (body.material && key.starts_with("materials." + name + "."))
      for (const MaterialParameter& p : parameters(*body.material))
        if (key == "materials." + name + "." + p.key) return *p.value;
  for (const MaterialParameter& p : parameters(*other.material))
    if (p.key == key) return *p.value;
  FAIL(key);
  return 0;
}

using Steps = std::vector<StepRecord>;

Steps steps_of(const SolveConfig& config, std::vector<Steps>* derivatives = nullptr) {
  Run run(test::mesh_in(config), config, config.material, test::nowhere, true);
  Sensitivity sensitivity(run, config, test::nowhere);
  Steps steps;
  RunListener each;
  each.of_whole = [&](StepRecord& whole, const SolveReport&) {
    steps.push_back(whole);
    if (derivatives) derivatives->push_back(sensitivity.now());
  };
  const RunEnd end = run.follow(derivatives ? sensitivity.along(each) : each);
  CAPTURE(end.path.why);
  REQUIRE(end.path.complete);
  return steps;
}

double norm(const std::vector<Vec3>& a) {
  double sum = 0;
  for (const Vec3& v : a) sum += v.squaredNorm();
  return std::sqrt(sum);
}
std::vector<Vec3> difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b,
                             double over = 1) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < a.size(); ++i) out.emplace_back((a[i] - b[i]) / over);
  return out;
}
bool same_status(const StepRecord& a, const StepRecord& b) {
  for (const auto& [name, contact] : a.contacts)
    if (contact.status != b.contacts.at(name).status) return false;
  return true;
}

// u', reactions' and forces' at every step that has no change of status, relative
void check(const std::string& text, const std::vector<std::string>& keys, double tolerance) {
  CAPTURE(text);
  const SolveConfig config = test::config_of(text + listed(keys));
  std::vector<Steps> found;
  steps_of(config, &found);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    CAPTURE(keys[i]);
    const double value = value_of(config, keys[i]);
    // a force hardly depends on d, and that in proportion: what rounding leaves of a difference
    // wants a longer one
    const double h = keys[i].ends_with("alpha")         ? 1e-2
                     : keys[i].ends_with("quadratic.d") ? 3e-2 * value
                                                        : 3e-4 * value;
    const auto [more, less] = varied(config, keys[i], h);
    const Steps plus = steps_of(more), minus = steps_of(less);
    REQUIRE(plus.size() == found.size());
    std::size_t compared = 0;
    double largest = 0;  // force
    double energy = 0;
    double moved = 0;
    for (const StepRecord& step : plus) {
      moved = std::max(moved, norm(step.u));
      largest = std::max(largest, step.force_ind.norm());
      energy = std::max(energy, step.scalars.at("energy"));
    }
    const double rounding = 2e-13 / h;  // what a difference leaves of values that do not change
    for (std::size_t s = 0; s < plus.size(); ++s) {
      if (!same_status(plus[s], minus[s])) break;
      // before and at the touch of an indenter that flies nothing depends on numbers
      if (config.dynamics && plus[s].force_ind.norm() < 1e-3 * largest) continue;
      const StepRecord& d = found[s][i];
      const auto du = difference(plus[s].u, minus[s].u, 2 * h),
                 dr = difference(plus[s].reaction, minus[s].reaction, 2 * h);
      const double of_reactions = rounding * (norm(plus[s].reaction) + largest);
      CHECK(norm(difference(d.u, du)) <= tolerance * norm(du) + rounding * moved);
      CHECK(norm(difference(d.reaction, dr)) <= tolerance * norm(dr) + of_reactions);
      const Vec3 dF = (plus[s].force_ind - minus[s].force_ind) / (2 * h);
      CHECK((d.force_ind - dF).norm() <= tolerance * dF.norm() + rounding * largest);
      if (norm(du) > 1e3 * rounding * moved) ++compared;
      const double dW = (plus[s].scalars.at("energy") - minus[s].scalars.at("energy")) / (2 * h);
      // Runs end at 1e-12 of their forces. A viscous body is not where its stored energy is least,
      // so that its energy has an error of this order.
      const double left = 1e-11 * energy / h;
      CHECK(std::abs(d.scalars.at("energy") - dW) <= 10 * tolerance * std::abs(dW) + left);
    }
    CHECK(compared > 0);
  }
}

// A ball of 2 g that bounces.
std::string flying_ball(double friction) {
  return "contacts: {ball: {on: contact, rigid: {sphere: {radius: 2.5, centre: [0, 5.52, 0]}}, "
         "friction: " +
         std::to_string(friction) + ", free: {mass_g: 2, velocity: [0, -300, 0]}}}\n";
}
const std::string bounce =
    "dynamics: {density_kg_m3: 1100, step: 1.0e-4}\npath: {seconds: 4.0e-3}\n"
    "solver: {newton: {relative: 1.0e-12}}\n";

const std::vector<std::string> some{"matrix.yeoh.a1", "fibres[0].hgo.c1", "fibres[0].alpha"};

}  // namespace

TEST_CASE(
    "derivatives of a run are those of runs: whole, half turn and quarter, with friction and without") {
  for (const char* symmetry : {"none", "half_turn"})
    check(block("hex8", "[6, 2, 6]") + "material: " + skin + ball(0) + four +
              "symmetry: " + symmetry + "\n",
          some, 1e-5);
  check(
      block("hex8", "[6, 2, 6]") + "material: " + skin + ball(0.3) + four + "symmetry: half_turn\n",
      {"matrix.yeoh.a1", "fibres[0].alpha", "contacts.ball.friction"}, 1e-3);
  check(block("hex8", "[6, 2, 6]") + "material: " + fat + ball(0.3) + four + "symmetry: quarter\n",
        {"matrix.yeoh.a1", "contacts.ball.friction"}, 1e-3);
}

TEST_CASE(
    "derivatives of a run are those of runs: hex27, layers, a section, a hexahedron for a mesh, KINSOL, a pushed indenter") {
  check(block("hex27", "[4, 2, 4]") + "material: " + skin + ball(0) + four,
        {"matrix.yeoh.a1", "volume.quadratic.d"}, 1e-5);
  check(block("hex8", "[6, 4, 6]",
              "  bodies: [{name: fat, thickness: 1.5}, {name: skin, thickness: 1.5}]\n") +
            "material: " + skin + "materials: {fat: {material: " + fat + "}}\n" + ball(0) + four,
        {"matrix.yeoh.a1", "materials.fat.matrix.yeoh.a1"}, 1e-5);
  check(
      "mesh:\n  geometry: {section: {of: axisymmetric, size: [6, 3], divisions: [8, 3]}}\n  sets: {contact: {of: top, within: {box: "
      "{from: [0, 2.9, -1], to: [2.4, 3.1, 1]}}}}\nsupports: [{on: bottom, hold: [x, y, z]}]\nmaterial: " +
          fat + ball(0.2) + four,
      {"matrix.yeoh.a1", "matrix.yeoh.a2", "contacts.ball.friction"}, 1e-3);
  const std::string pulled =
      "mesh: {geometry: {block: {size: [3, 1, 2], divisions: [3, 2, 2]}}}\nsupports: [{on: x_min, hold: [x]}, {on: bottom, hold: [y]}, "
      "{on: z_min, hold: [z]}]\nloads: [{on: x_max, displacement: {x: 0.9}}]\n";
  check(pulled + "material: " + skin + four,
        {"matrix.yeoh.a1", "fibres[0].hgo.c2", "fibres[0].alpha"}, 1e-5);
  check(block("hex8", "[6, 2, 6]") + "material: " + skin + ball(0) +
            "path: {steps: 4}\nsolver: {kinsol: {relative: 1.0e-12}}\nstability: off\n",
        some, 1e-5);
}

TEST_CASE(
    "derivatives by the thickness of a layer and the radius of an indenter are those of runs on meshes made anew") {
  const std::string radius = "contacts.ball.rigid.sphere.radius";
  const std::string height = "mesh.geometry.block.size[1]";
  const std::string layers =
      "  bodies: [{name: fat, thickness: 1.5}, {name: skin, thickness: 1.5}]\n";
  check(block("hex8", "[6, 2, 6]") + "material: " + skin + ball(0) + four, {radius, height}, 1e-5);
  check(block("hex8", "[6, 2, 6]", layers) + "material: " + skin +
            "materials: {fat: {material: " + fat + "}}\n" + ball(0) + four,
        {"mesh.bodies[0].thickness", "mesh.bodies[1].thickness"}, 1e-5);
  check(block("hex8", "[6, 2, 6]") + "material: " + fat + ball(0.3) + four + "symmetry: quarter\n",
        {radius, height}, 1e-3);
  check(block("hex27", "[4, 2, 4]") + "material: " + skin + ball(0) + four, {radius, height}, 1e-5);
  // almost incompressible: what a step of the thickness does to the pressures is large
  const std::string wet =
      "{matrix: {yeoh: {a1: 0.05, a2: 0.05}}, volume: {quadratic: {d: 1.0e-6}}}\n";
  check(block("hex8", "[4, 2, 4]") + "material: " + wet + ball(0) + four, {height}, 1e-5);
  check(block("hex27", "[4, 4, 4]", layers) + "material: " + skin +
            "materials: {fat: {material: " + fat + "}}\n" + ball(0) + four,
        {"mesh.bodies[0].thickness", "mesh.bodies[1].thickness"}, 1e-5);
  check(block("hex27", "[4, 2, 4]") + "material: " + fat + ball(0.3) + four + "symmetry: quarter\n",
        {radius, height}, 1e-3);
  check(
      "mesh:\n  geometry: {block: {origin: [-4, 0, -4], size: [8, 3, 8], divisions: [8, 2, 8]}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\nmaterial: " +
          fat +
          "contacts: {ball: {on: top, rigid: {cylinder: {radius: 1.7, edge: 0.6, face: [0, 3, 0]}}, motion: "
          "[{t: 1, to: [0, -0.6, 0]}]}}\n" +
          four,
      {"contacts.ball.rigid.cylinder.radius", height}, 1e-5);
}

namespace {

// Materials with two branches, of which one belongs to the fibres alone.
const std::string branches =
    "viscous: [{tau: 0.3, gamma: 0.8}, {tau: 2, gamma: 0.5, of: fibres}]}\n";
std::string with_branches(const std::string& material, const std::string& more) {
  return material.substr(0, material.rfind('}')) + ", " + more;
}
const std::string press_and_hold = "[{t: 0.25, to: [0, -0.6, 0]}, {t: 1, to: [0, -0.6, 0]}]";
const std::string four_in_two_seconds =
    "path: {steps: 4, seconds: 2}\nsolver: {newton: {relative: 1.0e-12}}\nstability: off\n";

}  // namespace

TEST_CASE("derivatives of a viscous run are those of runs, with what its branches remember") {
  const std::string viscous = with_branches(skin, branches);
  const std::string soft =
      with_branches(fat, "viscous: [{tau: 0.3, gamma: 0.8}, {tau: 2, gamma: 0.5}]}\n");
  check(block("hex8", "[6, 2, 6]") + "material: " + viscous + ball(0, press_and_hold) +
            four_in_two_seconds,
        {"matrix.yeoh.a1", "fibres[0].hgo.c2", "fibres[0].alpha", "viscous[0].tau",
         "viscous[0].gamma", "viscous[1].tau", "viscous[1].gamma",
         "contacts.ball.rigid.sphere.radius"},
        1e-5);
  check(block("hex27", "[4, 2, 4]") + "material: " + viscous + ball(0) + four_in_two_seconds,
        {"matrix.yeoh.a1", "viscous[0].tau", "viscous[1].gamma"}, 1e-5);
  check(block("hex8", "[6, 4, 6]",
              "  bodies: [{name: fat, thickness: 1.5}, {name: skin, thickness: 1.5}]\n") +
            "material: " + viscous + "materials: {fat: {material: " + soft + "}}\n" + ball(0) +
            four_in_two_seconds,
        {"matrix.yeoh.a1", "viscous[0].tau", "materials.fat.viscous[1].gamma"}, 1e-5);
  check(block("hex8", "[6, 2, 6]") + "material: " + soft + ball(0.3, press_and_hold) +
            four_in_two_seconds + "symmetry: quarter\n",
        {"matrix.yeoh.a1", "viscous[0].tau", "contacts.ball.friction"}, 1e-3);
  // one hexahedron in place of a mesh
  check(
      "mesh: {geometry: {block: {size: [3, 1, 2], divisions: [3, 2, 2]}}}\nsupports: [{on: x_min, "
      "hold: [x]}, {on: bottom, hold: [y]}, {on: z_min, hold: [z]}]\nloads: [{on: x_max, "
      "displacement: {x: 0.9}}]\nmaterial: " +
          viscous + four_in_two_seconds,
      {"matrix.yeoh.a1", "fibres[0].hgo.c2", "viscous[0].tau", "viscous[1].gamma"}, 1e-5);
  // a continuous spectrum of the fibres; one of all terms would hardly change the displacements
  check(block("hex8", "[4, 2, 4]") + "material: " +
            with_branches(skin, "spectrum: {c: 0.3, tau1: 0.1, tau2: 10, of: fibres}}\n") +
            ball(0) + four_in_two_seconds,
        {"matrix.yeoh.a2", "spectrum.c"}, 1e-5);
}

TEST_CASE("numbers that a viscous body cannot be differentiated by are refused with the reason") {
  const auto said = [](const std::string& key, const std::string& more = "") {
    const SolveConfig config =
        test::config_of(block("hex8", "[4, 2, 4]") + "material: " +
                        with_branches(fat, "spectrum: {c: 0.3, tau1: 0.1, tau2: 10}}\n") + ball(0) +
                        (more.empty() ? four_in_two_seconds : more) + listed({key}));
    try {
      Run run(test::mesh_in(config), config, config.material, test::nowhere);
      const Sensitivity sensitivity(run, config, test::nowhere);
    } catch (const Failure& failure) {
      CHECK(failure.code() == Exit::config);
      return std::string(failure.what());
    }
    return std::string("accepted");
  };
  CHECK(said("spectrum.c") == "accepted");
  CHECK(said("spectrum.tau1").find("which decides how many branches there are") !=
        std::string::npos);
  CHECK(said("mesh.geometry.block.size[1]").find("and a material is viscous") != std::string::npos);
  CHECK(said("matrix.yeoh.a1", bounce).find("a viscous material together with dynamics") !=
        std::string::npos);
}

TEST_CASE("derivatives by loads are those of runs: displacements, rotations, forces, pressures") {
  const std::string plate =
      "mesh:\n  geometry: {block: {origin: [-4, 0, -4], size: [8, 3, 8], divisions: [8, 2, 8]}}\n"
      "  sets: {disc: {of: top, within: {cylinder: {axis: y, radius: 2}}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\nmaterial: " +
      skin;
  const auto loaded = [&](const std::string& load) {
    return plate + "loads: [{on: disc, " + load + "}]\n" + four;
  };
  check(loaded("displacement: {y: -0.4, x: 0.2}"),
        {"loads[0].displacement.y", "loads[0].displacement.x"}, 1e-5);
  check(loaded("rotation: {angle: 20}"), {"loads[0].rotation.angle"}, 1e-5);
  check(loaded("force: {y: 0.4, z: 0.2}"), {"loads[0].force.y", "matrix.yeoh.a1"}, 1e-5);
  check(loaded("traction: {x: 0.02}"), {"loads[0].traction.x"}, 1e-5);
  check(loaded("pressure: -0.02"), {"loads[0].pressure"}, 1e-5);
  // together with an indenter under force control, with friction, and with viscous branches; how
  // close to balance a sliding one comes is a matter of rounding
  std::string closely = four;
  closely.replace(closely.find("1.0e-12"), 7, "1.0e-11");
  std::string free_to_slide = plate;
  free_to_slide.replace(free_to_slide.find("[{on: bottom, hold: [x, y, z]}]"), 31,
                        "[{on: bottom, hold: [y]}, {on: x_min, hold: [x, z]}]");
  check(free_to_slide +
            "loads: [{on: x_max, displacement: {x: 0.8}}]\n"
            "contacts: {ball: {on: disc, rigid: {sphere: {radius: 2.5, centre: [0, 5.5, 0]}}, "
            "friction: 0.3, control: {force: 1, along: [0, -1, 0]}}}\n" +
            closely,
        {"loads[0].displacement.x", "contacts.ball.control.force"}, 1e-3);
  check(plate.substr(0, plate.find("material: ")) + "material: " + with_branches(skin, branches) +
            "loads: [{on: disc, pressure: -0.02}]\n" + four_in_two_seconds,
        {"loads[0].pressure", "viscous[0].gamma"}, 1e-5);
  // one hexahedron in place of a mesh
  check(
      "mesh: {geometry: {block: {size: [3, 1, 2], divisions: [3, 2, 2]}}}\nsupports: [{on: x_min, "
      "hold: [x]}, {on: bottom, hold: [y]}, {on: z_min, hold: [z]}]\nloads: [{on: x_max, "
      "displacement: {x: 0.9}}]\nmaterial: " +
          skin + four,
      {"loads[0].displacement.x"}, 1e-5);
}

namespace {

// A ball that is pressed in, lifted above the surface, and held by what it has touched.
std::string sticky(const std::string& law, double friction = 0, double up = 0.1) {
  return "contacts: {ball: {on: contact, rigid: {sphere: {radius: 2.5, centre: [0, 5.5, 0]}}, "
         "friction: " +
         std::to_string(friction) + ", adhesion: {" + law +
         "}, motion: [{t: 0.5, to: [0, -0.6, 0]}, {t: 1, to: [0, " + std::to_string(up) +
         ", 0]}]}}\n";
}
const std::string eight =
    "path: {steps: 8}\nsolver: {newton: {relative: 1.0e-12}}\nstability: off\n";

}  // namespace

TEST_CASE("derivatives through adhesion are those of runs: bonds that hold and that come loose") {
  const std::string body = block("hex8", "[6, 2, 6]") + "material: " + skin;
  const std::string work = "contacts.ball.adhesion.work";
  const std::string stiffness = "contacts.ball.adhesion.stiffness";
  const std::string tangential = "contacts.ball.adhesion.tangential";
  const std::string radius = "contacts.ball.rigid.sphere.radius";
  // none comes loose
  check(body + sticky("work: 0.1, stiffness: 0.5") + eight,
        {"matrix.yeoh.a1", "fibres[0].alpha", stiffness, radius, "mesh.geometry.block.size[1]"},
        1e-5);
  // some do, at once and slowly, and some come back
  check(body + sticky("work: 2.0e-3, stiffness: 0.1, tangential: 0.05") + eight,
        {"matrix.yeoh.a1", work, stiffness, tangential, radius}, 1e-5);
  check(body + sticky("work: 1.0e-3, stiffness: 0.5, viscosity: 2.0e-3") +
            "path: {steps: 8, seconds: 4}\nsolver: {newton: {relative: 1.0e-12}}\nstability: off\n",
        {"matrix.yeoh.a1", work, "contacts.ball.adhesion.viscosity"}, 1e-5);
  // a residual of 1e-12 is below rounding where the ball slips: some increments would be halved
  check(body + sticky("work: 2.0e-3, stiffness: 0.1, tangential: 0.05", 0.3) +
            "path: {steps: 8}\nsolver: {newton: {relative: 1.0e-10}}\nstability: off\n",
        {"matrix.yeoh.a1", work, tangential, "contacts.ball.friction"}, 1e-3);
  std::string heals = sticky("work: 2.0e-3, stiffness: 0.1, healing: true");
  heals.replace(heals.find("{t: 1, to:"), 10, "{t: 0.75, to: [0, 0.1, 0]}, {t: 1, to:");
  heals.replace(heals.rfind("0.100000"), 8, "-0.3");
  check(body + heals + "symmetry: half_turn\n" + eight, {"matrix.yeoh.a1", work, stiffness}, 1e-5);
}

TEST_CASE("one of two equal loads takes the symmetry away, and a history has no derivative") {
  const std::string scene =
      "mesh: {geometry: {block: {origin: [-2, 0, -2], size: [4, 2, 4], divisions: [4, 2, 4]}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\nmaterial: " +
      fat + "loads: [{on: x_min, traction: {x: LEFT}}, {on: x_max, traction: {x: 0.01}}]\n" + four;
  const auto kept = [&](const std::string& left, const std::string& asked) {
    std::string text = scene;
    text.replace(text.find("LEFT"), 4, left);
    const SolveConfig config = test::config_of(text + asked);
    return Run(test::mesh_in(config), config, config.material, test::nowhere).reduction.words();
  };
  CHECK(kept("-0.01", "").find("mirror x and mirror z") != std::string::npos);
  const std::string one_side = kept("-0.01", listed({"loads[0].traction.x"}));
  CHECK(one_side.find("mirror x") == std::string::npos);
  CHECK(one_side.find("mirror z") != std::string::npos);
  CHECK_THROWS_WITH_AS(kept("[{t: 1, to: -0.01}]", listed({"loads[0].traction.x"})),
                       doctest::Contains("a load with a history has no single number"), Failure);
}

// scalars of the last step against differences of runs
void check_scalar(const std::string& text, const std::string& scalar, const std::string& derivative,
                  const std::string& key, double tolerance) {
  CAPTURE(scalar);
  const SolveConfig config = test::config_of(text + listed({key}));
  std::vector<Steps> found;
  const double told = steps_of(config, &found).back().scalars.at(derivative),
               value = value_of(config, key), h = 3e-4 * value;
  const auto [more, less] = varied(config, key, h);
  const auto last = [&](const SolveConfig& other) {
    const StepRecord end = steps_of(other).back();
    return scalar == "apex"
               ? end.u[static_cast<std::size_t>(test::mesh_in(config).node_sets.at("apex")[0])][1]
               : end.scalars.at(scalar);
  };
  const double difference = (last(more) - last(less)) / (2 * h);
  CHECK(told == near(difference, tolerance));
}

TEST_CASE(
    "derivatives of torques, of pushed indenters with friction and of what a suction lifts are those of runs") {
  std::string disc = block("hex8", "[6, 2, 6]");
  disc.insert(disc.find("sets: {") + 7,
              "disc: {of: top, within: {cylinder: {axis: y, radius: 2}}}, ");
  check_scalar(disc + "material: " + skin + "loads: [{on: disc, rotation: {angle: 20}}]\n" + four,
               "torque_disc", "d_torque_disc_N_mm_d_matrix_yeoh_a1", "matrix.yeoh.a1", 1e-5);
  // the angle and the displacement of the axis move the nodes that the torque is taken of
  const std::string askew =
      disc + "material: " + skin +
      "loads: [{on: disc, rotation: {angle: 30, through: [1.5, 2, 0.5], axis: [0.2, 1, 0.1]}, "
      "displacement: {x: 0.2, y: -0.2}}]\n" +
      four;
  check_scalar(askew, "torque_disc", "d_torque_disc_N_mm_d_loads_0_rotation_angle",
               "loads[0].rotation.angle", 1e-5);
  check_scalar(askew, "torque_disc", "d_torque_disc_N_mm_d_loads_0_displacement_y",
               "loads[0].displacement.y", 1e-5);
  check_scalar(
      block("hex8", "[6, 2, 6]") + "material: " + skin +
          "contacts: {ball: {on: contact, rigid: {sphere: {radius: 2.5, centre: [0, 5.5, 0]}}, friction: 0.2, motion: [{t: 0.5, "
          "to: [0, -0.6, 0]}, {t: 1, to: [0, -0.6, 0]}], rotation: [{t: 0.5, to: 0}, {t: 1, to: 20}]}}\n" +
          four,
      "torque_ball", "d_torque_ball_N_mm_d_matrix_yeoh_a1", "matrix.yeoh.a1", 1e-3);
  check_scalar(
      block("hex8", "[6, 2, 6]") + "material: " + skin +
          "contacts: {ball: {on: contact, rigid: {sphere: {radius: 2.5, centre: [0, 5.5, 0]}}, friction: 0.3, control: {force: "
          "2, along: [0.4, -1, 0]}}}\n" +
          four,
      "travel_ball", "d_travel_ball_mm_d_matrix_yeoh_a1", "matrix.yeoh.a1", 1e-3);
  check_scalar(
      "mesh:\n  geometry: {block: {origin: [-4, 0, -4], size: [8, 3, 8], divisions: [8, 2, 8]}}\n  points: {apex: [0, 3, 0]}\n  "
      "sets: {hole: {of: top, within: {cylinder: {axis: y, radius: 2}}}}\nsupports: [{on: bottom, hold: [x, y, z]}]\nmaterial: " +
          skin + "loads: [{on: hole, pressure: -0.02}]\n" + four,
      "apex", "d_u_y_apex_mm_d_matrix_yeoh_a1", "matrix.yeoh.a1", 1e-5);
}

TEST_CASE(
    "a number that breaks the symmetry of a scene takes the symmetry away, or is refused where that is named") {
  const std::string straight =
      "{matrix: {yeoh: {a1: 0.05, a2: 0.05}}, fibres: [{hgo: {c1: 0.1, c2: 0.3}, alpha: 0}], volume: {quadratic: {d: 1.0e-3}}}\n";
  const std::string scene = block("hex8", "[6, 2, 6]") + "material: " + straight + ball(0) + four;
  const auto kept = [&](const std::string& symmetry, const std::vector<std::string>& keys) {
    const SolveConfig config =
        test::config_of(scene + "symmetry: " + symmetry + "\n" + listed(keys));
    return Run(test::mesh_in(config), config, config.material, test::nowhere).reduction.words();
  };
  CHECK(kept("auto", {"matrix.yeoh.a1"}).find("mirror x and mirror z") != std::string::npos);
  CHECK(kept("auto", {"fibres[0].alpha"}).find("half turn") != std::string::npos);
  CHECK_THROWS_WITH_AS(kept("quarter", {"fibres[0].alpha"}), doctest::Contains("sensitivity"),
                       Failure);
}

TEST_CASE("numbers that a scene does not have are refused with those that it has") {
  const auto said = [](const std::string& key) {
    const SolveConfig config = test::config_of(block("hex8", "[4, 2, 4]") + "material: " + fat +
                                               ball(0) + four + listed({key}));
    try {
      const Run run(test::mesh_in(config), config, config.material, test::nowhere);
    } catch (const Failure& failure) {
      CHECK(failure.code() == Exit::config);
      return std::string(failure.what());
    }
    return std::string("accepted");
  };
  CHECK(said("matrix.yeoh.a1") == "accepted");
  CHECK(said("matrix.yeho.a1").find("did you mean \"matrix.yeoh.a1\"?") != std::string::npos);
  CHECK(said("fibres[0].alpha").find("expected a number of the scene: matrix.yeoh.a1") !=
        std::string::npos);
  CHECK(said("contacts.ball.friction").find("friction above 0") != std::string::npos);
}

// Frequencies depend on a number through the law, the state and its contact reactions.
TEST_CASE("derivatives of frequencies are those of whole runs with other numbers") {
  const std::vector<std::string> keys{"matrix.yeoh.a1", "fibres[0].hgo.c1", "fibres[0].hgo.c2",
                                      "fibres[0].alpha", "contacts.ball.friction"};
  const SolveConfig config =
      test::config_of(block("hex8", "[5, 2, 5]") + "material: " + skin +
                      ball(0.3, "[{t: 0.5, to: [0, -0.5, 0]}, {t: 1, to: [0.3, -0.5, 0]}]") +
                      "path: {steps: 4}\nsolver: {newton: {relative: 1.0e-12}}\nstability: off\n"
                      "dynamics: {density_kg_m3: 1100}\nmodes: {count: 4}\n" +
                      listed(keys));
  const auto modes_of_run = [](const SolveConfig& of, bool with_derivatives) {
    Run run(test::mesh_in(of), of, of.material, test::nowhere);
    Sensitivity sensitivity(run, of, test::nowhere);
    REQUIRE(run.follow(with_derivatives ? sensitivity.along({}) : RunListener{}).path.complete);
    ModesListener add;
    if (with_derivatives)
      add = [&](const Modes& modes, const std::vector<double>& density, ModesRecord& record) {
        sensitivity.add_frequencies(modes, density, record);
      };
    return *vibration_of(of, run, test::nowhere, add)->modes;
  };
  const ModesRecord found = modes_of_run(config, true);
  REQUIRE(found.derivatives.size() == keys.size());
  const std::vector<double> without = modes_of_run(config, false).frequency;
  for (std::size_t mode = 0; mode < without.size(); ++mode)
    CHECK(found.frequency[mode] == near(without[mode], 1e-8));
  for (std::size_t i = 0; i < keys.size(); ++i) {
    CAPTURE(keys[i]);
    const double h = keys[i] == "fibres[0].alpha" ? 0.05 : 1e-3 * value_of(config, keys[i]);
    const auto [more, less] = varied(config, keys[i], h);
    const std::vector<double> high = modes_of_run(more, false).frequency;
    const std::vector<double> low = modes_of_run(less, false).frequency;
    for (std::size_t mode = 0; mode < found.frequency.size(); ++mode) {
      CAPTURE(mode);
      const double difference = (high[mode] - low[mode]) / (2 * h);
      // of a number that hardly matters, relative to the frequency for a change of 1
      const double size = 1e-5 * found.frequency[mode] / (1 + value_of(config, keys[i]));
      CHECK(found.derivatives[i].second[mode] == near(difference, 1e-4, size));
    }
  }
}

TEST_CASE("derivatives of a body in motion are those of runs: whole, a quarter, a section") {
  const std::vector<std::string> keys{"matrix.yeoh.a1", "fibres[0].hgo.c1"};
  check(block("hex8", "[8, 4, 8]") + "material: " + skin + flying_ball(0) + bounce, keys, 1e-4);
  check(block("hex27", "[4, 2, 4]") + "material: " + skin + flying_ball(0) + bounce +
            "symmetry: none\n",
        keys, 1e-4);
  check(block("hex8", "[8, 4, 8]") + "material: " + fat + flying_ball(0.3) + bounce +
            "symmetry: quarter\n",
        {"matrix.yeoh.a1", "contacts.ball.friction", "contacts.ball.rigid.sphere.radius"}, 1e-3);
  check(
      "mesh:\n  geometry: {section: {of: axisymmetric, size: [6, 4], divisions: [8, 6]}}\n  sets: "
      "{contact: {of: top, within: {box: {from: [0, 3.9, -1], to: [2.4, 4.1, 1]}}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\nmaterial: " +
          fat +
          "contacts: {ball: {on: contact, rigid: {sphere: {radius: 2.5, centre: [0, 6.52, 0]}}, "
          "free: {mass_g: 2, velocity: [0, -300, 0]}}}\n" +
          bounce,
      {"matrix.yeoh.a1", "matrix.yeoh.a2"}, 1e-4);
}

TEST_CASE("derivatives of peak force and restitution are those of runs") {
  const std::vector<std::string> keys{"matrix.yeoh.a1", "fibres[0].hgo.c1",
                                      "contacts.ball.friction"};
  const SolveConfig config =
      test::config_of(block("hex8", "[8, 4, 8]") + "material: " + skin + flying_ball(0.3) +
                      "dynamics: {density_kg_m3: 1100, step: 2.5e-4, damping: {mass_per_s: 20}}\n"
                      "path: {seconds: 9.0e-3}\nsolver: {newton: {relative: 1.0e-12}}\n" +
                      listed(keys));
  const auto results = [](const SolveConfig& of, bool with_derivatives) {
    Run run(test::mesh_in(of), of, of.material, test::nowhere);
    Sensitivity sensitivity(run, of, test::nowhere);
    ImpactResults impact(run.scene, run.inertia.get());
    RunListener each;
    each.of_whole = [&](StepRecord& whole, const SolveReport&) {
      impact.add(whole);
    };
    REQUIRE(run.follow(with_derivatives ? sensitivity.along(each) : each).path.complete);
    std::map<std::string, double> out;
    for (const Summary& one : impact.summary()) out[one.name] = one.value;
    return out;
  };
  const std::map<std::string, double> found = results(config, true);
  Run run(test::mesh_in(config), config, config.material, test::nowhere);
  const std::vector<SceneParameter> numbers = Sensitivity(run, config, test::nowhere).parameters();
  for (const std::string& key : keys) {
    CAPTURE(key);
    const double h = 1e-3 * value_of(config, key);
    const auto [more, less] = varied(config, key, h);
    const auto high = results(more, false);
    const auto low = results(less, false);
    const SceneParameter& number = *std::ranges::find(numbers, key, &SceneParameter::key);
    for (const char* name : {"peak_force", "restitution"}) {
      CAPTURE(name);
      const double difference = (high.at(name) - low.at(name)) / (2 * h);
      const double size = 1e-3 * found.at(name) / value_of(config, key);
      CHECK(found.at(derivative_name(name, number)) == near(difference, 1e-3, size));
    }
  }
}

// A run continued from these steps has the derivatives of the whole one to the last digit.
void check_continued(const SolveConfig& config, const std::vector<std::size_t>& from) {
  std::vector<Steps> derivatives;
  const Steps whole = steps_of(config, &derivatives);
  for (std::size_t at : from) {
    Run run(test::mesh_in(config), config, config.material, test::nowhere);
    Sensitivity sensitivity(run, config, test::nowhere);
    for (std::size_t s = 0; s <= at; ++s) {
      run.replay(whole[s]);
      sensitivity.kept(whole[s]);
    }
    run.resume(whole[at], at > 0 ? std::optional(whole[at - 1]) : std::nullopt);
    std::size_t next = at + 1;
    RunListener each;
    each.of_whole = [&](StepRecord& step, const SolveReport&) {
      CHECK(step.scalars == whole[next].scalars);
      CHECK(step.point_fields == whole[next].point_fields);
      ++next;
    };
    run.follow(sensitivity.along(each));
    CHECK(next == whole.size());
  }
}

TEST_CASE("a run continued from any of its steps has the same derivatives to the last digit") {
  const std::vector<std::string> keys{"matrix.yeoh.a1", "contacts.ball.friction"};
  const std::string body = block("hex8", "[8, 4, 8]") + "material: " + skin;
  check_continued(
      test::config_of(block("hex8", "[6, 2, 6]") + "material: " + skin +
                      ball(0.3, "[{t: 0.5, to: [0, -0.5, 0]}, {t: 1, to: [0.3, -0.5, 0]}]") + four +
                      listed(keys)),
      {0, 1, 2});
  check_continued(test::config_of(body + flying_ball(0.3) + bounce + listed(keys)), {0, 5, 16});
  check_continued(
      test::config_of(block("hex8", "[6, 2, 6]") + "material: " + with_branches(skin, branches) +
                      ball(0.3, press_and_hold) + four_in_two_seconds +
                      listed({"matrix.yeoh.a1", "viscous[0].tau", "contacts.ball.friction"})),
      {0, 1, 2});
}

TEST_CASE(
    "derivatives through adhesion end where bonds let go in a jump, and continue when killed") {
  const std::string body = block("hex8", "[6, 2, 6]") + "material: " + skin;
  const std::string keys = listed({"matrix.yeoh.a1", "contacts.ball.adhesion.work"});
  const SolveConfig jumps =
      test::config_of(body + sticky("work: 5.0e-3, stiffness: 3", 0, 2) +
                      "path: {first: 0.1, largest: 0.1}\nstability: off\n" + keys);
  std::vector<Steps> derivatives;
  CHECK_THROWS_WITH_AS(steps_of(jumps, &derivatives), doctest::Contains("let go in a jump"),
                       Failure);
  CHECK(!derivatives.empty());  // of the steps before
  const SolveConfig config = test::config_of(
      body + sticky("work: 2.0e-3, stiffness: 0.1, tangential: 0.05", 0.3) + eight + keys);
  check_continued(config, {0, 3, 5, 6});
  CHECK_THROWS_WITH_AS(
      steps_of(test::config_of(body + sticky("work: 2.0e-3, stiffness: 0.5") + eight +
                               listed({"contacts.ball.adhesion.tangential"}))),
      doctest::Contains("tangential above 0"), Failure);
}

TEST_CASE(
    "the tangents of derivatives serve the increments behind them, whose states change by no more than their tolerance") {
  const std::string scene = block("hex8", "[8, 3, 8]") + "material: " + skin +
                            ball(0.3, "[{t: 1, to: [0, -0.8, 0]}]") +
                            "path: {steps: 10}\nstability: off\n";
  long tangents[2];
  Vec3 force[2];
  for (int asked : {0, 1}) {
    const SolveConfig config = test::config_of(scene + (asked ? listed(some) : std::string()));
    Run run(test::mesh_in(config), config, config.material, test::nowhere);
    Sensitivity sensitivity(run, config, test::nowhere);
    RunListener each;
    each.of_whole = [&, asked](StepRecord& whole, const SolveReport&) {
      force[asked] = whole.force_ind;
    };
    REQUIRE(run.follow(sensitivity.along(each)).path.complete);
    tangents[asked] = run.increment.cost().factorizations;
  }
  CAPTURE(tangents[0]);
  CAPTURE(tangents[1]);
  CHECK(tangents[1] - tangents[0] < 7);  // of ten
  CHECK((force[1] - force[0]).norm() < 1e-6 * force[0].norm());
}

TEST_CASE("derivatives by numbers that are 0 or almost 0 have all their digits") {
  // GOH beside its bounds: no dispersion, or next to none
  const std::string goh =
      "{matrix: {yeoh: {a1: 0.05, a2: A2, a3: 0.02}}, fibres: [{hgo: {c1: 0.1, c2: 0.3}, alpha: 30, switch: \"off\", kappa: KAPPA}], "
      "volume: {quadratic: {d: 1.0e-3}}}\n";
  const std::vector<std::string> keys{"matrix.yeoh.a2", "fibres[0].kappa"};
  std::vector<Steps> found[2];
  for (int small : {0, 1}) {
    std::string law = goh;
    law.replace(law.find("A2"), 2, small ? "1.0e-11" : "0");
    law.replace(law.find("KAPPA"), 5, small ? "1.0e-9" : "0");
    steps_of(test::config_of(block("hex8", "[4, 2, 4]") + "material: " + law + ball(0) + four +
                             listed(keys)),
             &found[small]);
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const StepRecord &zero = found[0].back()[i], &small = found[1].back()[i];
    CAPTURE(keys[i]);
    CHECK(norm(difference(zero.u, small.u)) < 1e-7 * norm(zero.u));
    CHECK((zero.force_ind - small.force_ind).norm() < 1e-7 * zero.force_ind.norm());
  }
}

}  // namespace sensitivity_tests
