// Bodies of random size that become unstable, with a critical place on the path that another method
// knows: struts between clamps and cantilevers (Euler), stiff films on soft layers in plane strain
// (langer-layers), shallow clamped caps under pressure (the limit point of a path with arc lengths
// on a finer mesh).
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "accuracy/checks/run_watch.hpp"
#include "layers/wrinkle.hpp"
#include "scene/model/make_mesh.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/run.hpp"

namespace langer::test {

struct DrawnInstability {
  std::string kind;
  std::string scene;
  double critical_t = 0;  // by the reference
  double unsure = 0;      // of the reference, relative
};

struct FoundInstability {
  double before = 0;  // the last step that is stable
  double after = 0;   // the first that is not, or where no equilibrium was found any more
  std::optional<CriticalPoint> critical;
};

// With the keys of the scene alone, as langer-solve follows it. from, to: the first increment in
// which the count of negative eigenvalues changes, or that finds no equilibrium.
inline FoundInstability find_instability(const std::string& scene) {
  const auto no_place = [](const std::string&) {
    return Place{};
  };
  const SolveConfig config = read_config<SolveConfig>(parse_yaml(scene, "scene.yaml")).config;
  Run run(make_mesh(*config.mesh, no_place).mesh, config, config.material, no_place);
  RunWatch watch(run, config, no_place, {});
  FoundInstability found;
  std::vector<double> steps;
  RunListener listener;
  listener.of_part = [&](StepRecord& step) {
    const bool goes_on = watch.of_part(step);
    if (found.after == 0 && step.scalars.at("negative_eigenvalues") != 0) found.after = step.t;
    if (found.after == 0) found.before = step.t;
    steps.push_back(step.t);
    return goes_on;
  };
  // the increment that fails first at a limit point is the one that contains it
  double failed = 0;
  listener.failed = [&](double t, const SolveReport&) {
    if (failed == 0) failed = t;
  };
  const RunEnd end = run.follow(listener);
  watch.locate(end);
  found.critical = watch.critical();
  if (found.after > 0) return found;
  found.after = failed;
  if (!end.path.complete || !found.critical) return found;
  // a jump to a distant state that is stable: the increment in which it happened
  const double t = found.critical->t;
  const auto next = std::lower_bound(steps.begin(), steps.end(), t);
  found.after = next == steps.end() ? 1 : *next;
  found.before = next == steps.begin() ? 0 : *(next - 1);
  return found;
}

class InstabilityDraw {
 public:
  explicit InstabilityDraw(unsigned seed) : random_(seed) {}

  DrawnInstability next(int i) {
    if (i % 3 == 0) return strut();
    if (i % 3 == 1) return film();
    return cap();
  }

  // hex27 along the strut, one across: its end faces stay plane and may grow sideways.
  DrawnInstability strut() {
    const double thickness = between(0.3, 2);
    const double slenderness = between(30, 60);
    const double length = slenderness * thickness;
    const double width = between(1.2, 3) * thickness;
    const double a1 = between(0.01, 1);
    const bool clamped = between(0, 1) < 0.5;
    const double past = between(1.3, 4);  // where the path ends, in critical loads
    // strain of a clamped one, pi^2 h^2 / (3 L^2); of a cantilever a sixteenth
    const double strain = std::pow(std::numbers::pi / slenderness, 2) / (clamped ? 3.0 : 48.0);
    std::string load = fmt::format("displacement: {{x: {:.12g}}}", -past * strain * length);
    if (!clamped)
      load = fmt::format("force: {{x: {:.12g}}}", -past * strain * 6 * a1 * thickness * width);
    // where the tip is free to move aside, it is not held
    std::string held = "{on: a, hold: [y, z]}, {on: b, hold: [y]}";
    if (clamped) held += ", {on: c, hold: [y, z]}";
    return {
        clamped ? "clamped strut" : "cantilever",
        fmt::format(
            "mesh: {{geometry: {{block: {{origin: [0, 0, 0], size: [{0}, {1}, {2}], divisions: [24, 1, 1]}}}}, "
            "cells: hex27, points: {{a: [0, 0, 0], b: [0, 0, {2}], c: [{0}, 0, 0]}}}}\n"
            "supports: [{{on: x_min, hold: [x]}}, {3}]\n"
            "loads: [{{on: x_max, {4}}}]\n"
            "material: {{matrix: {{neo_hooke: {{a1: {5}}}}}, volume: {{quadratic: {{d: {6}}}}}}}\n",
            length, thickness, width, held, load, a1, 1e-3 / a1),
        1 / past, 0.01};
  }

  // One wavelength of the first wrinkle, between symmetry planes.
  DrawnInstability film() {
    const double thickness = between(0.05, 0.5);
    const double soft = between(0.002, 0.02);
    const double contrast = std::exp(between(std::log(8.0), std::log(200.0)));
    const double past = between(1.3, 2.5);
    const auto layer = [](const std::string& name, double a1, double height) {
      const Material material{
          .matrix = {NeoHooke{a1}}, .fibres = {}, .volume = QuadraticVolume{1e-4 / a1}};
      return Layer{name, material, {}, height, 1.1e-9};
    };
    WrinkleProblem problem;
    problem.layers = {layer("film", contrast * soft, thickness),
                      layer("soft", soft, std::numeric_limits<double>::infinity())};
    const Wrinkle wrinkle = first_wrinkle(problem, 0);
    const double wave = wrinkle.wavelength_before;
    const double depth = 1.5 * wave;
    const double strain = 1 - wrinkle.s;
    return {
        "film",
        fmt::format(
            "mesh: {{geometry: {{section: {{of: plane_strain, size: [{0}, {1}], divisions: [8, 10], top: {{edge: {2}}}}}}}, "
            "cells: hex27, bodies: [{{name: soft, thickness: {3}}}, {{name: film, thickness: {4}}}]}}\n"
            "materials:\n"
            "  soft: {{material: {{matrix: {{neo_hooke: {{a1: {5}}}}}, volume: {{quadratic: {{d: {6}}}}}}}}}\n"
            "  film: {{material: {{matrix: {{neo_hooke: {{a1: {7}}}}}, volume: {{quadratic: {{d: {8}}}}}}}}}\n"
            "supports: [{{on: bottom, hold: [y]}}, {{on: x_min, hold: [x]}}]\n"
            "loads: [{{on: x_max, displacement: {{x: {9:.12g}}}}}]\n",
            wave, depth + thickness, 0.5 * thickness, depth, thickness, soft, 1e-4 / soft,
            contrast * soft, 1e-4 / (contrast * soft), -past * strain * wave),
        1 / past, 0.002};
  }

  DrawnInstability cap() {
    const double radius = between(60, 140);
    const double thickness = between(0.8, 1.5);
    // half the arc, for a shallowness at which the cap snaps without waves around its axis
    const double rise = between(1.8, 2.4) * thickness;
    const double half = std::sqrt(2 * radius * rise);
    const double a1 = between(0.02, 0.5);
    const double past = between(1.2, 2);
    const double scale = a1 * std::pow(thickness / radius, 2);
    const auto scene = [&](double pressure, int cells, const std::string& path) {
      return fmt::format(
          "mesh: {{geometry: {{section: {{of: axisymmetric, size: [{0}, {1}], divisions: [{2}, 1]}}}}, bend: {3}, cells: hex27}}\n"
          "supports: [{{on: x_max, hold: [x, y]}}]\n"
          "loads: [{{on: top, pressure: {4:.12g}}}]\n"
          "material: {{matrix: {{neo_hooke: {{a1: {5}}}}}, volume: {{quadratic: {{d: {6}}}}}}}\n{7}",
          half, thickness, cells, radius, pressure, a1, 1e-3 / a1, path);
    };
    const FoundInstability fine = find_instability(
        scene(4 * scale, 24,
              fmt::format("path: {{first: 0.01, largest: 0.03, arc_length: {{length: {}}}}}\n",
                          1.5 * rise)));
    double factor = 0;
    if (fine.critical) factor = fine.critical->load_factor;
    return {"cap", scene(4 * scale * factor * past, 12, ""), 1 / past, 0.005};
  }

 private:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  std::mt19937_64 random_;
};

}  // namespace langer::test
