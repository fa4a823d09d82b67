// Schemes and laws of contact on the bar of Doyen, Ern and Piperno [2011]: error of the contact
// pressure and change of energy over the step; and a block that tumbles for 10 000 steps.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/stopwatch.hpp"
#include "dynamics/bar_on_wall.hpp"

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
    const BodyState& now = block.statics().accepted();
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
  tumble(1, 10000);
  tumble(2, 10000);
}
