// Instabilities against closed forms: where a body becomes unstable, what that is, and what comes
// after.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "accuracy/checks/branch.hpp"
#include "accuracy/checks/run_watch.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace critical_points_tests {

namespace {

struct Followed {
  std::vector<StepRecord> steps;
  std::optional<CriticalPoint> critical;
  bool complete = false;
  std::string why;
  Mesh mesh;

  std::vector<double> history(const std::string& name) const {
    std::vector<double> values;
    for (const StepRecord& step : steps) values.push_back(step.scalars.at(name));
    return values;
  }
};

const Voice quiet{"test", true};

// Solves a scene as langer-solve does. from: steps that a killed run left.
Followed followed(const std::string& text, const std::vector<StepRecord>& from = {}) {
  const SolveConfig config = test::config_of(text);
  Mesh mesh = test::mesh_in(config);
  std::optional<Branch> branch;
  if (config.imperfection)
    mesh = imperfect_mesh(quiet, std::move(mesh), config, config.material, test::nowhere);
  if (config.branch) branch = branch_of(quiet, mesh, config, config.material, test::nowhere);
  Run run(mesh, config, config.material, test::nowhere);
  if (branch) run.switch_branch(branch->at);
  RunWatch watch(run, config, test::nowhere, {});
  if (branch) watch.know(branch->bifurcation);
  Followed out;
  for (const StepRecord& step : from) watch.kept(step);
  if (!from.empty()) {
    std::optional<StepRecord> before;
    if (from.size() > 1) before = from[from.size() - 2];
    run.resume(from.back(), before);
    run.resume_all();
  }
  RunListener listener;
  listener.of_part = [&](StepRecord& step) {
    return watch.of_part(step);
  };
  listener.of_whole = [&](StepRecord& step, const SolveReport&) {
    out.steps.push_back(step);
  };
  const RunEnd end = run.follow(listener);
  watch.locate(end);
  out.critical = watch.critical();
  out.complete = end.path.complete;
  out.why = end.path.why;
  out.mesh = mesh;
  return out;
}

// ---- balloons ----

struct Balloon {
  double radius = 9.95, thickness = 0.1;  // inner [mm]
  std::string law = "neo_hooke: {a1: 0.5}";
  double stretch = 2;  // of the inner surface, at the end
  std::string path = "{first: 0.005, largest: 0.05}";
  int cells = 6, layers = 1;
};

double volume_of(double inner, double stretch) {
  return 2 * std::numbers::pi / 3 * std::pow(inner, 3) * (std::pow(stretch, 3) - 1);
}

std::string scene(const Balloon& b) {
  return fmt::format(
      "mesh: {{geometry: {{section: {{of: axisymmetric, origin: [0, {0}], size: [{1:.17g}, {2}], "
      "divisions: [{6}, {7}]}}}}, bend: {0}, cells: hex27}}\n"
      "supports: [{{on: x_max, hold: [y]}}]\n"
      "loads: [{{on: bottom, volume: {3:.17g}}}]\n"
      "material: {{matrix: {{{4}}}, volume: {{quadratic: {{d: 1.0e-5}}}}}}\n"
      "estimate: none\npath: {5}\n",
      b.radius, b.radius * std::numbers::pi / 2, b.thickness, volume_of(b.radius, b.stretch), b.law,
      b.path, b.cells, b.layers);
}

// Pressure of an incompressible spherical shell at a stretch of its inner surface:
//   p = integral from l_b to l_a of W'(l) / (l^3 - 1) dl,   W(l) of equibiaxial stretch l
template <class Slope>
double shell_pressure(const Balloon& b, double l_a, const Slope& slope) {
  const double A3 = std::pow(b.radius, 3);
  const double B3 = std::pow(b.radius + b.thickness, 3);
  const double l_b = std::cbrt(1 + A3 * (std::pow(l_a, 3) - 1) / B3);
  const int n = 2000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double l = l_b + (l_a - l_b) * (i + 0.5) / n;
    sum += slope(l) / (l * l * l - 1) * (l_a - l_b) / n;
  }
  return sum;
}

double inner_stretch(const Balloon& b, double volume) {
  return std::cbrt(1 + 3 * volume / (2 * std::numbers::pi * std::pow(b.radius, 3)));
}

double neo_hooke(double l) { return 2 * (l - std::pow(l, -5)); }  // mu = 1 MPa

}  // namespace

TEST_CASE("balloon: a thin one has its greatest pressure where the membrane has it") {
  Balloon balloon;
  balloon.path = "{first: 0.005, largest: 0.02}";
  const Followed found = followed(scene(balloon));
  REQUIRE(found.complete);
  double greatest = 0;
  double at = 0;
  for (const StepRecord& step : found.steps) {
    if (step.scalars.at("load_pressure") < greatest) continue;
    greatest = step.scalars.at("load_pressure");
    at = inner_stretch(balloon, step.scalars.at("pumped_volume"));
  }
  CHECK(greatest == near(1.23946 * balloon.thickness / 10, 0.005));
  CHECK(at == near(1.38309, 0.02));
  for (double negative : found.history("negative_eigenvalues")) CHECK(negative == 0);
  CHECK_FALSE(found.critical);
}

TEST_CASE("balloon: a thick shell has the pressure of the radial integral") {
  Balloon balloon;
  balloon.radius = 5;
  balloon.thickness = 5;
  balloon.layers = 3;
  balloon.path = "{first: 0.02, largest: 0.2}";
  const Followed found = followed(scene(balloon));
  REQUIRE(found.complete);
  for (const StepRecord& step : found.steps) {
    const double l = inner_stretch(balloon, step.scalars.at("pumped_volume"));
    CHECK(step.scalars.at("load_pressure") == near(shell_pressure(balloon, l, neo_hooke), 0.002));
  }
}

TEST_CASE("balloon: both limit points of Mooney and Rivlin's law are passed") {
  Balloon balloon;
  balloon.law = "mooney_rivlin: {c10: 0.455, c01: 0.045}";
  balloon.stretch = 4;
  balloon.path = "{first: 0.001, largest: 0.1}";
  const auto slope = [](double l) {
    return 4 * 0.455 * (l - std::pow(l, -5)) + 4 * 0.045 * (std::pow(l, 3) - std::pow(l, -3));
  };
  const Followed found = followed(scene(balloon));
  REQUIRE(found.complete);
  int turns = 0;
  const std::vector<double> p = found.history("load_pressure");
  for (std::size_t i = 1; i + 1 < p.size(); ++i) turns += (p[i + 1] - p[i]) * (p[i] - p[i - 1]) < 0;
  CHECK(turns == 2);
  for (const StepRecord& step : found.steps) {
    const double l = inner_stretch(balloon, step.scalars.at("pumped_volume"));
    CHECK(step.scalars.at("load_pressure") == near(shell_pressure(balloon, l, slope), 0.005));
  }
}

// ---- struts ----

namespace {

struct Strut {
  double length = 40, thickness = 0.5, width = 0.75;
  // The end faces stay plane and upright, and may grow sideways as the strip does.
  std::string ends =
      "supports: [{on: x_min, hold: [x]}, {on: a, hold: [y, z]}, {on: b, hold: [y]}, {on: c, hold: [y, z]}]\n"
      "loads: [{on: x_max, displacement: {x: -2}}]\n";
  std::string path = "{first: 0.003, largest: 0.1}";
  std::string more;
  int cells = 24;
};

std::string scene(const Strut& s) {
  return fmt::format(
      "mesh: {{geometry: {{block: {{origin: [{0}, {1}, {2}], size: [{3}, {4}, {5}], divisions: [{6}, 1, "
      "1]}}}}, cells: hex27, points: {{middle: [0, {1}, {2}], a: [{0}, {1}, {2}], b: [{0}, {1}, {7}], "
      "c: [{8}, {1}, {2}]}}}}\n{9}"
      "material: {{matrix: {{neo_hooke: {{a1: 0.5}}}}, volume: {{quadratic: {{d: 1.0e-3}}}}}}\n"
      "estimate: none\npath: {10}\n{11}\n",
      -0.5 * s.length, -0.5 * s.thickness, -0.5 * s.width, s.length, s.thickness, s.width, s.cells,
      0.5 * s.width, 0.5 * s.length, s.ends, s.path, s.more);
}

double second_moment(const Strut& s) { return s.width * std::pow(s.thickness, 3) / 12; }

// Deflection of the middle of a clamped strip that is shortened, by Euler's elastica:
//   shortening / length = 2 - 2 E(k) / K(k),   deflection / length = k / K(k)
// and what the force 16 K^2 E I / L^2 shortens along the axis, as far as that lies along x.
double elastica(const Strut& s, double shortening) {
  double k = 0;
  double low = 0;
  double high = 0.9;
  for (int i = 0; i < 60; ++i) {
    k = 0.5 * (low + high);
    const double K = std::comp_ellint_1(k);
    const double E = std::comp_ellint_2(k);
    const double strain =
        16 * K * K * second_moment(s) / (s.thickness * s.width * s.length * s.length);
    const double found = 2 - 2 * E / K + strain * (2 * E / K - 1);
    (found < shortening / s.length ? low : high) = k;
  }
  return k / std::comp_ellint_1(k) * s.length;
}

}  // namespace

TEST_CASE("strip: the critical load of a clamped one is Euler's, and a bifurcation") {
  const Followed found = followed(scene(Strut{}));
  REQUIRE(found.complete);
  REQUIRE(found.critical);
  CHECK(found.critical->kind == "bifurcation");
  CHECK(found.critical->symmetry == "symmetric in x, antisymmetric in y, symmetric in z");
  // strain 4 pi^2 I / (A L^2) of the shortening that straightness takes
  const Strut strut;
  const double strain = std::pow(std::numbers::pi * strut.thickness / strut.length, 2) / 3;
  const double shortening = strain * strut.length / 2;  // as a share of 2 mm
  CHECK(found.critical->t == near(shortening, 0.005));
}

TEST_CASE("strip: both branches follow the elastica, and are stable") {
  for (const char* sign : {"positive", "negative"}) {
    Strut strut;
    strut.more = fmt::format("branch: {{take: follow, sign: {}}}", sign);
    const Followed found = followed(scene(strut));
    CAPTURE(found.why);
    REQUIRE(found.complete);
    REQUIRE(found.critical);
    const StepRecord& last = found.steps.back();
    const auto middle = static_cast<std::size_t>(found.mesh.node_sets.at("middle").front());
    const double deflection = elastica(strut, 2);
    const double up = std::string(sign) == "positive" ? 1 : -1;
    CHECK(up * last.u[middle][1] == near(deflection, 0.01));
    CHECK(last.scalars.at("negative_eigenvalues") == 0);
    CHECK(last.scalars.at("branch") == up);
  }
}

TEST_CASE("strut: a cantilever under a dead force buckles at Euler's load") {
  Strut strut;
  strut.length = 20;
  strut.cells = 8;
  const double euler = std::pow(std::numbers::pi / strut.length, 2) / 4 * 3 * second_moment(strut);
  strut.ends = fmt::format(
      "supports: [{{on: x_min, hold: [x]}}, {{on: a, hold: [y, z]}}, {{on: b, hold: [y]}}]\n"
      "loads: [{{on: x_max, force: {{x: {:.17g}}}}}]\n",
      -1.5 * euler);
  strut.path = "{first: 0.2, largest: 0.2}";
  const Followed found = followed(scene(strut));
  REQUIRE(found.critical);
  CHECK(found.critical->kind == "bifurcation");
  CHECK(found.critical->t == near(1 / 1.5, 0.005));
}

TEST_CASE("strip: an imperfect one bends towards the branch") {
  Strut strut;
  strut.path = "{first: 0.0003, largest: 0.05, arc_length: {length: 3.5}}";
  strut.more = "imperfection: {mode: 1, amplitude: 0.05}";
  const Followed imperfect = followed(scene(strut));
  CAPTURE(imperfect.why);
  REQUIRE(imperfect.complete);
  const StepRecord& last = imperfect.steps.back();
  const auto middle = static_cast<std::size_t>(imperfect.mesh.node_sets.at("middle").front());
  const double deflection = elastica(strut, 2 * last.scalars.at("load_factor"));
  CHECK(last.u[middle][1] == near(deflection, 0.01));
  for (double negative : imperfect.history("negative_eigenvalues")) CHECK(negative == 0);
}

// ---- a cap ----

namespace {

const std::string cap_scene =
    "mesh: {geometry: {section: {of: axisymmetric, size: [20, 1], divisions: [10, 1]}}, bend: 100, "
    "cells: hex27, points: {apex: [0, 1, 0]}}\n"
    "supports: [{on: x_max, hold: [x, y]}]\n"
    "loads: [{on: top, pressure: PRESSURE}]\n"
    "material: {matrix: {neo_hooke: {a1: 0.1666666667}}, volume: {quadratic: {d: 1.0e-2}}}\n"
    "estimate: none\n";

// Under a share of 1.5e-4 MPa.
std::string cap_under(double share) {
  std::string text = cap_scene;
  return text.replace(text.find("PRESSURE"), 8, fmt::format("{:.17g}", 1.5e-4 * share));
}
const std::string cap = cap_under(1);

}  // namespace

TEST_CASE("cap: arc length passes both limit points at little cost, and stops nowhere") {
  const Followed found =
      followed(cap + "path: {first: 0.01, largest: 0.04, arc_length: {length: 3}}\n");
  CAPTURE(found.why);
  REQUIRE(found.complete);
  REQUIRE(found.critical);
  CHECK(found.critical->kind == "limit point of load");
  const std::vector<double> load = found.history("load_factor");
  const std::vector<double> negative = found.history("negative_eigenvalues");
  int turns = 0;
  for (std::size_t i = 1; i + 1 < load.size(); ++i)
    turns += (load[i + 1] - load[i]) * (load[i] - load[i - 1]) < 0;
  CHECK(turns == 2);
  CHECK(negative.front() == 0);
  CHECK(negative.back() == 0);
  // iterations of stable steps and of those between the limit points
  double stable = 0;
  double unstable = 0;
  double n_stable = 0;
  double n_unstable = 0;
  for (std::size_t i = 0; i < load.size(); ++i) {
    (negative[i] == 0 ? stable : unstable) += found.steps[i].iterations;
    (negative[i] == 0 ? n_stable : n_unstable) += 1;
  }
  REQUIRE(n_unstable > 2);
  CHECK(unstable / n_unstable <= 2 * stable / n_stable);

  // bracketed by the steps next to it, and greater than all of them
  const double greatest = *std::max_element(load.begin(), load.begin() + load.size() / 2);
  CHECK(found.critical->load_factor >= greatest);
  CHECK(found.critical->load_factor == near(greatest, 0.005));

  // below it given pressures find the equilibria of the same path
  const Followed pushed =
      followed(cap_under(0.9 * greatest) + "path: {first: 0.1, largest: 0.1}\n");
  REQUIRE(pushed.complete);
  CHECK(pushed.history("negative_eigenvalues").back() == 0);
}

TEST_CASE("cap: a path with arc lengths goes on with the same digits after a kill") {
  const std::string text = cap + "path: {first: 0.02, largest: 0.08, arc_length: {length: 3}}\n";
  const Followed whole = followed(text);
  REQUIRE(whole.complete);
  const std::size_t half = whole.steps.size() / 2;
  const std::vector<StepRecord> kept(whole.steps.begin(), whole.steps.begin() + half);
  const Followed rest = followed(text, kept);
  REQUIRE(rest.complete);
  REQUIRE(rest.steps.size() == whole.steps.size() - half);
  CHECK(rest.steps.back().u == whole.steps.back().u);
  CHECK(rest.steps.back().scalars.at("load_factor") ==
        whole.steps.back().scalars.at("load_factor"));
  REQUIRE(rest.critical);
  CHECK(rest.critical->t == whole.critical->t);
}

TEST_CASE("the length of an arc is that of displacements as they are seen from rest") {
  const auto words = [](const std::string& path) {
    const SolveConfig config = test::config_of(
        "mesh: {geometry: {block: {size: [4, 1, 2], divisions: [4, 1, 2]}}}\n"
        "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1.0e-2}}}\n"
        "supports: [{on: x_min, hold: [x, y, z]}, {on: x_max, hold: [y, z]}]\n"
        "loads: [{on: x_max, displacement: {x: 0.4}}]\npath: " +
        path + "\n");
    return Run(test::mesh_in(config), config, config.material, test::nowhere).reduction.words();
  };
  CHECK(words("{steps: 2}").starts_with("symmetry: mirror x and mirror z"));
  CHECK(words("{steps: 2, arc_length: {length: 0.4}}").starts_with("symmetry: mirror z"));
}

}  // namespace critical_points_tests
