// Schemes and laws of contact on the bar of Doyen, Ern and Piperno [2011]: error of the contact
// pressure and change of energy over the step; what inertia costs an iteration; and a block that
// tumbles for 10 000 steps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "accuracy/bouncing_ball.hpp"
#include "core/base/stopwatch.hpp"
#include "dynamics/bar_on_wall.hpp"
#include "scene/model/make_mesh.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/run.hpp"

using namespace langer;

namespace {

struct SchemeOnWall {
  const char* name;
  InertiaOptions options;
};

InertiaOptions on_wall(Scheme scheme, double number, bool moved) {
  InertiaOptions options;
  options.scheme = scheme;
  options.rho_inf = number;
  if (scheme == Scheme::theta) options.theta = options.xi = number;
  if (moved) options.massless = {1};  // sized and set for the candidates
  return options;
}

// Two panels: deviation of the pressure and change of energy, over steps per cell.
void draw_schemes(const std::vector<SchemeOnWall>& schemes) {
  std::ofstream plot("contact_schemes.gp");
  plot << "set terminal svg size 900,420 font 'sans,12' background rgb 'white'\n"
          "set output 'contact_schemes.svg'\nset datafile separator ','\n"
          "set multiplot layout 1,2\nset logscale xy\nset format y '%g'\n"
          "set xlabel 'step over the time of a wave in a cell'\n"
          "set xtics (0.125, 0.25, 0.5, 1, 2)\nset yrange [1e-4:1e4]\nset xrange [0.1:2.5]\n";
  for (int column : {3, 4}) {
    plot << (column == 3
                 ? "set ylabel 'deviation of the contact pressure, %'\nset nokey\nplot "
                 : "set ylabel 'change of energy, %'\nset key outside bottom center vertical "
                   "font ',10'\nplot ");
    for (std::size_t i = 0; i < schemes.size(); ++i) {
      plot << (i > 0 ? ", " : "")
           << fmt::format(
                  "'contact_schemes.csv' using 2:(strcol(1) eq '{0}' ? abs(${1}) : NaN) "
                  "with linespoints pt {2} lc {2} title '{0}'",
                  schemes[i].name, column, i + 1);
    }
    plot << "\n";
  }
  plot.close();
  if (std::system("gnuplot contact_schemes.gp") != 0) fmt::print("no gnuplot: no picture\n");
}

void tumble(int n, int steps) {
  const Mesh mesh = test::block(test::even(0, 2, n), test::even(0, 1, n), test::even(0, 1.4, n));
  InertiaOptions options;
  options.scheme = Scheme::energy_momentum;
  options.density = {1e-9};
  options.spin = Vec3(900, 500, -1400);
  options.spin_centre = Vec3(1, 0.5, 0.7);
  test::Moving block(mesh, test::neo_hooke(0.05, 2), number_dofs(mesh.n_nodes(), {}).dofs, options,
                     {}, 5e-5, steps);
  const auto angular = [&] {
    const BodyState& now = block.increment().accepted();
    return block.inertia().angular_momentum(now.u, now.motion);
  };
  const double energy = block.energy();
  const Vec3 spin = angular();
  double energy_off = 0, spin_off = 0;
  const double begun = cpu_seconds();
  for (int i = 0; i < steps; ++i) {
    block.step(1e-12);
    energy_off = std::max(energy_off, std::abs(block.energy() / energy - 1));
    spin_off = std::max(spin_off, (angular() - spin).norm() / spin.norm());
  }
  fmt::print(
      "tumbling block, {0} x {0} x {0} hex8, {1} steps of {2:.3f} rad: energy off by {3:.1e}, angular momentum by "
      "{4:.1e}, {5:.1f} s CPU\n",
      n, steps, 5e-5 * options.spin.norm(), energy_off, spin_off, cpu_seconds() - begun);
}

struct Cost {
  double seconds = 0;  // of CPU
  int iterations = 0;
};

// A block of n x n/3 x n hex8 into which a sphere is pressed in ten increments.
Cost pressed(int n, const std::string& inertia) {
  const std::string text = fmt::format(
      "mesh:\n  geometry: {{block: {{origin: [-6, 0, -6], size: [12, 4, 12], divisions: [{0}, {1}, {0}]}}}}\n"
      "  sets: {{contact: {{of: top, within: {{cylinder: {{axis: y, radius: 3}}}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y, z]}}]\nsymmetry: none\nstability: off\n"
      "material: {{matrix: {{yeoh: {{a1: 0.05, a2: 0.03}}}}, volume: {{quadratic: {{d: 0.1}}}}}}\n"
      "contacts: {{ball: {{on: contact, rigid: {{sphere: {{radius: 4, centre: [0, 8, 0]}}}},\n"
      "  friction: 0.3, motion: [{{t: 1, to: [0, -1, 0]}}]}}}}\n"
      "path: {{seconds: 1, steps: 10}}\n{2}",
      n, n / 3, inertia);
  const SolveConfig config = read_config<SolveConfig>(parse_yaml(text, "scene.yaml")).config;
  Run run(make_mesh(*config.mesh, test::no_place).mesh, config, config.material, test::no_place);
  const double begun = cpu_seconds();
  const RunEnd end = run.follow();
  if (!end.path.complete) throw std::runtime_error("the block is not pressed to the end");
  return {cpu_seconds() - begun, end.path.iterations};
}

// What inertia costs: CPU seconds of an iteration with it over those without it, in turns.
void compare_costs(int n) {
  std::vector<double> ratios;
  for (int i = 0; i < 3; ++i) {
    const Cost still = pressed(n, "");
    const Cost moves = pressed(n, "dynamics: {density_kg_m3: 1100}\n");
    ratios.push_back(moves.seconds / moves.iterations / (still.seconds / still.iterations));
    fmt::print(
        "block of {0} x {1} x {0} hex8 under a sphere, ten increments: {2:.2f} CPU s and {3} "
        "iterations; in motion {4:.2f} s and {5}\n",
        n, n / 3, still.seconds, still.iterations, moves.seconds, moves.iterations);
  }
  std::sort(ratios.begin(), ratios.end());
  fmt::print("  an iteration in motion costs {:.2f} times one without inertia (median)\n",
             ratios[1]);
}

// Bars of drawn bounces against meshes and increments that are finer by 2.5.
void check_bars(int n) {
  std::mt19937 random(20261128);
  std::uniform_real_distribution<double> share(0, 1);
  std::map<std::string, int> holds;
  std::map<std::string, std::vector<double>> bars, errors;  // relative
  for (int i = 0; i < n; ++i) {
    const test::FlyingBall ball{2 + 3 * share(random), 100 + 250 * share(random),
                                0.5 + 2 * share(random)};
    const int cells = 12 + static_cast<int>(8 * share(random));
    const double step = 1.8e-3 / cells;
    const SolveConfig config = test::bounce(cells, ball, fmt::format("step: {:g}", step));
    const test::Impact solved = test::impact_of(config);
    const test::Impact reference =
        test::impact_of(test::bounce(5 * cells / 2, ball, fmt::format("step: {:g}", step / 2.5)));
    for (const ErrorEstimate& e : test::errors_of(config, solved)) {
      const double off = std::abs(e.of.value - reference.of(e.of.name));
      if (off <= e.total()) ++holds[e.of.name];
      bars[e.of.name].push_back(e.total() / e.of.value);
      errors[e.of.name].push_back(off / e.of.value);
    }
  }
  const auto median = [](std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  };
  fmt::print("bars of {} drawn bounces (median of bars, of errors, in %):\n", n);
  for (const auto& [name, values] : bars) {
    fmt::print("  {:<14} holds {} of {}, {:.2g}, {:.2g}\n", name, holds[name], values.size(),
               100 * median(values), 100 * median(errors[name]));
  }
}

}  // namespace

// langer-bench motion: a table, contact_schemes.csv and contact_schemes.svg in this folder
void measure_motion() {
  const int cells = 40;
  std::vector<SchemeOnWall> schemes;
  for (bool moved : {true, false}) {
    const auto add = [&](const char* name, Scheme scheme, double number) {
      schemes.push_back({name, on_wall(scheme, number, moved)});
    };
    add(moved ? "generalised alpha 1, mass moved" : "generalised alpha 1, mass kept",
        Scheme::generalised_alpha, 1);
    add(moved ? "generalised alpha 0.8, mass moved" : "generalised alpha 0.8, mass kept",
        Scheme::generalised_alpha, 0.8);
    add(moved ? "generalised alpha 0, mass moved" : "generalised alpha 0, mass kept",
        Scheme::generalised_alpha, 0);
    add(moved ? "theta 0.5, mass moved" : "theta 0.5, mass kept", Scheme::theta, 0.5);
    add(moved ? "theta 0.6, mass moved" : "theta 0.6, mass kept", Scheme::theta, 0.6);
  }
  std::ofstream table("contact_schemes.csv");
  table << "scheme,step,deviation_percent,energy_percent\n";
  fmt::print(
      "bar on a wall, {} cells: step over the time of a wave in a cell, deviation of the "
      "contact pressure (rms) and change of energy in %\n",
      cells);
  for (const SchemeOnWall& one : schemes) {
    for (double steps : {0.5, 1., 2., 4., 8.}) {
      try {
        const test::Pressure found = test::bar_on_wall(cells, steps, one.options);
        table << fmt::format("\"{}\",{:g},{:.4g},{:.4g}\n", one.name, 1 / steps, 100 * found.rms,
                             100 * found.energy);
        fmt::print("  {:<34} {:>6g} {:>10.3g} {:>10.3g}\n", one.name, 1 / steps, 100 * found.rms,
                   100 * found.energy);
      } catch (const std::runtime_error& error) {
        fmt::print("  {:<34} {:>6g}  {}\n", one.name, 1 / steps, error.what());
      }
      std::fflush(stdout);
    }
  }
  table.close();
  draw_schemes(schemes);
  for (int n : {12, 24}) compare_costs(n);
  check_bars(16);
  tumble(1, 10000);
  tumble(2, 10000);
}
