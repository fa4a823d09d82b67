// Forces, tractions and pressures of a config: what symmetry and sections make of them, their
// energy, and what is refused.
#include "scene/model/scene_loads.hpp"

#include <doctest/doctest.h>

#include <numbers>

#include "mechanics/mesh/section.hpp"
#include "results/post/energy_columns.hpp"
#include "scene/run/post_files.hpp"
#include "support/block.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace loads_tests {

using test::config_of, test::mesh_in, test::nowhere;

namespace {

struct Ended {
  Mesh mesh;
  std::vector<StepRecord> steps;
  std::string words;
  Vec3 reaction(const std::string& set) const {
    Vec3 sum = Vec3::Zero();
    for (int n : mesh.node_sets.at(set)) sum += steps.back().reaction[n];
    return sum;
  }
};

Ended solved(const std::string& text) {
  const SolveConfig config = config_of(text);
  Ended out{mesh_in(config), {}, ""};
  const Scene scene = make_scene(config, out.mesh, config.material, nowhere);
  const auto part = ReducedScene::find(config.symmetry, out.mesh, scene, nowhere);
  if (part) out.words = part->words();
  test::HowToSolve how;
  how.path = config.path, how.solver = config.solver;
  out.steps = test::solved(out.mesh, scene, part, how).steps;
  return out;
}

std::string block(const std::string& loads, const std::string& more = "",
                  const std::string& cells = "hex8") {
  return "mesh: {geometry: {block: {size: [4, 1.5, 3], divisions: [4, 2, 5]}}, cells: " + cells +
         "}\n" +
         "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-2}}}\n"
         "supports: [{on: bottom, hold: [x, y, z]}]\nsolver: {newton: {relative: 1.0e-11}}\npath: {largest: 0.25}\nloads: " +
         loads + "\n" + more;
}

double apart(const Ended& a, const Ended& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.steps.back().u.size(); ++i)
    most = std::max({most, (a.steps.back().u[i] - b.steps.back().u[i]).norm(),
                     (a.steps.back().reaction[i] - b.steps.back().reaction[i]).norm()});
  return most;
}

}  // namespace

TEST_CASE("a force is borne by the supports as a whole, spread over any set of facets") {
  for (const char* cells : {"hex8", "hex27"}) {
    const Ended end = solved(block("[{on: top, force: {x: 0.05, y: -0.2, z: 0.03}}]", "", cells));
    CHECK((end.reaction("bottom") + Vec3(0.05, -0.2, 0.03)).norm() < 1e-8);
  }
  const Ended both = solved(block(
      "[{on: top, traction: {y: -0.01}}, {on: x_max, force: {y: [{t: 0.5, to: 0.1}, {t: 1, to: 0.05}]}}]"));
  CHECK((both.reaction("bottom") - Vec3(0, 0.01 * 12 - 0.05, 0)).norm() < 1e-8);
}

TEST_CASE(
    "symmetry finds loads that are their own image: part and whole agree, also where the planes cut cells") {
  for (const auto& [loads, expected] :
       {std::pair{"[{on: top, pressure: 0.01}]", "mirror x and mirror z"},
        {"[{on: x_max, pressure: 0.01}, {on: x_min, pressure: 0.01}, {on: top, force: {y: 0.1}}]",
         "mirror x and mirror z"},
        {"[{on: x_max, pressure: 0.01}]", "mirror z"},
        {"[{on: top, force: {x: 0.05, y: -0.1}}]", "mirror z"},
        {"[{on: x_max, traction: {z: 0.01}}, {on: x_min, traction: {z: -0.01}}]", "half turn"}}) {
    const std::string shown = loads;
    CAPTURE(shown);
    const Ended whole = solved(block(loads)), part = solved(block(loads, "symmetry: auto\n"));
    CHECK(part.words.substr(0, std::string(expected).size()) == expected);
    CHECK(apart(whole, part) < 1e-8);
  }
  CHECK(solved(block("[{on: top, force: {x: 0.05, z: 0.02}}]", "symmetry: auto\n")).words.empty());
}

TEST_CASE(
    "an axisymmetric section under inside pressure is the thick-walled tube, in plane strain") {
  const double A = 1, B = 2, p = 0.02, a1 = 0.05;
  // the radius at which the closed form has this pressure
  const auto pressure = [&](double a) {
    double sum = 0;
    for (int i = 0; i < 20000; ++i) {
      const double R = A + (B - A) * (i + 0.5) / 20000, r2 = R * R + a * a - A * A,
                   l2 = r2 / (R * R);
      sum += 2 * a1 * (l2 - 1 / l2) * R / r2 * (B - A) / 20000;
    }
    return sum;
  };
  double low = 1, high = 1.6;
  for (int i = 0; i < 60; ++i) (pressure(0.5 * (low + high)) < p ? low : high) = 0.5 * (low + high);
  std::vector<double> errors;
  for (int n : {4, 8, 16}) {
    const Ended end = solved(
        "mesh: {geometry: {section: {of: axisymmetric, origin: [1, 0], size: [1, 0.25], divisions: [" +
        std::to_string(n) +
        ", 1]}}}\nmaterial: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-6}}}\n"
        "supports: [{on: bottom, hold: [y]}, {on: top, hold: [y]}]\nloads: [{on: x_min, pressure: 0.02}]\n"
        "path: {largest: 0.25}\n");
    errors.push_back(
        std::abs(A + end.steps.back().u[end.mesh.node_sets.at("x_min").front()][0] - low));
  }
  CAPTURE(errors[0]);
  CAPTURE(errors[1]);
  CAPTURE(errors[2]);
  CHECK(errors[2] < 2e-3 * (low - A));
  CHECK(std::log2(errors[1] / errors[2]) > 1.8);
  // a force is that of the whole circle
  const Ended pressed = solved(
      "mesh: {geometry: {section: {of: axisymmetric, size: [2, 1], divisions: [4, 2]}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-2}}}\n"
      "supports: [{on: bottom, hold: [x, y]}]\nloads: [{on: top, force: {y: -0.3}}, {on: x_max, pressure: 0.001}]\n");
  // The side bulges, and the pressure on it then has a share along y: the pressure times the ring
  // between the circles at the top and at the bottom.
  const auto& u = pressed.steps.back().u;
  double top = 0;
  for (int node : pressed.mesh.node_sets.at("x_max")) {
    if (pressed.mesh.X[node][1] == 1) top = 2 + u[node][0];
  }
  const double ring = std::numbers::pi * (top * top - 4);
  CHECK(ring > 0.1);
  CHECK(pressed.reaction("bottom")[1] == near(0.3 - 0.001 * ring, 1e-6));
}

TEST_CASE(
    "the work of dead loads and pressures is what the body stores: energy balances, on parts and sections too") {
  const auto balance = [](const std::string& text) {
    const SolveConfig config = config_of(text);
    const Ended end = solved(text);
    std::vector<Error> errors;
    std::vector<SurfaceLoad> loads = surface_loads(config, end.mesh, nowhere, errors);
    REQUIRE(errors.empty());
    std::vector<double> share;
    if (end.mesh.section)
      share.assign(static_cast<std::size_t>(end.mesh.n_cells()), cell_share(*end.mesh.section));
    const Loads forces(end.mesh, loads, share);
    EnergyPath path(end.mesh, {}, {0.5});
    StepRecord rest;
    rest.u.assign(end.mesh.X.size(), Vec3::Zero()), rest.reaction = rest.u;
    path.add(energy_state(rest, {}, forces));
    for (const StepRecord& step : end.steps) path.add(energy_state(step, {}, forces));
    const auto sums = path.sums();
    CHECK(sums.back().work > 1e-4);
    double worst = 0;  // at first, errors are divided by little work
    for (std::size_t i = 6; i < sums.size(); ++i)
      worst = std::max(worst, std::abs(sums[i].balance));
    return worst;
  };
  const std::string fine = "path: {first: 0.05, largest: 0.05}\n";
  const auto with = [&](const std::string& loads) {
    std::string text = block(loads, "symmetry: auto\n");
    return text.replace(text.find("path: {largest: 0.25}\n"), 22, fine);
  };
  CHECK(balance(with("[{on: top, pressure: 0.03}]")) < 1e-3);
  CHECK(balance(with("[{on: top, force: {y: 0.4}}]")) < 1e-3);
  CHECK(
      balance(with(
          "[{on: top, pressure: [{t: 0.5, to: 0.03}, {t: 1, to: 0.01}]}, {on: x_max, traction: {x: 0.01}}]")) <
      1e-3);
  CHECK(
      balance(
          "mesh: {geometry: {section: {of: axisymmetric, size: [2, 1], divisions: [4, 2]}}}\n"
          "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-2}}}\n"
          "supports: [{on: bottom, hold: [x, y]}]\nloads: [{on: top, pressure: 0.03}, {on: x_max, pressure: 0.01}]\n" +
          fine) < 1e-3);
}

TEST_CASE("what a load cannot be is refused at its key") {
  const auto says = [](const std::string& text) {
    const SolveConfig config = config_of(text);
    return test::said_of_scene(text, mesh_in(config));
  };
  const auto of_block = [&](const std::string& loads) {
    return says(block(loads));
  };
  CHECK(of_block("[{on: top, pressure: 0.01}]") == "accepted");
  CHECK(of_block("[{on: tip, pressure: 0.01}]").find("loads[0].on") != std::string::npos);
  const std::string point = of_block("[{on: P, force: {y: -1}}]\n").substr(0, 400);
  CHECK(point.find("a node set of the mesh") != std::string::npos);
  std::string text = block("[{on: P, force: {y: -1}}]");
  text.replace(text.find("}}, cells"), 2, "}}, sets: {P: {within: {nearest: {to: [0, 1.5, 0]}}}}");
  CHECK(says(text).find("a set without facets") != std::string::npos);
  CHECK(says(text).find("loads[0].on") != std::string::npos);
  CHECK(of_block("[{on: bottom, force: {y: -1}}]")
            .find("loads[0].force.y: every node of \"bottom\" is held") != std::string::npos);
  CHECK(of_block("[{on: top, displacement: {x: 1}}, {on: top, traction: {x: -1}}]")
            .find("loads[1].traction.x") != std::string::npos);
  const std::string pushed =
      "[]\ncontacts: {ball: {on: bottom, rigid: {sphere: {radius: 1, centre: [2, 3, 1.5]}}, control: {force: 1}}}";
  CHECK(of_block(pushed).find("contacts.ball.on: the surface of \"bottom\" faces away") !=
        std::string::npos);
  const std::string section =
      "mesh: {geometry: {section: {of: axisymmetric, size: [2, 1], divisions: [4, 2]}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-2}}}\nsupports: [{on: bottom, hold: [x, y]}]\nloads: ";
  CHECK(says(section + "[{on: top, force: {y: -1}}]") == "accepted");
  CHECK(
      says(section + "[{on: top, force: {x: -1}}]").find("loads[0].force.x: found on a section") !=
      std::string::npos);
}

}  // namespace loads_tests
