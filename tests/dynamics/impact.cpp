// Impact: a bar on a wall and an indenter with mass on a column.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "dynamics/moving.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// Sides held across: a column in one-dimensional strain, with the modulus K + 4 G / 3.
Dofs column_dofs(const Mesh& mesh, bool clamped) {
  std::vector<Prescribed> held;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    held.push_back({3 * i, 0});
    held.push_back({3 * i + 2, 0});
    if (clamped && mesh.X[i][1] == 0) held.push_back({3 * i + 1, 0});
  }
  return number_dofs(mesh.n_nodes(), held).dofs;
}

RigidContact wall(const Mesh& mesh, double gap, double mu = 0) {
  RigidContact contact;
  contact.name = "wall";
  contact.shape = Plane{{0, -gap, 0}, {0, 1, 0}};
  contact.mu = mu;
  contact.nodes = mesh.node_sets.at("y_min");
  contact.motion = {{1, Vec3::Zero()}};
  return contact;
}

struct Pressure {
  double mean = 0, rms = 0;     // over that of the wave, in its middle part
  double touch = 0, leave = 0;  // [s]
  double energy = 0;            // change at the end, relative
};

// Doyen, Ern and Piperno's bar [2011], in mm, N and s: length 10, wave speed 30 000, as fast that
// its strain is 0.001. It meets the wall after 0.3 of the time that a wave takes forth and back.
Pressure bar_on_wall(int cells, double steps_per_cell, InertiaOptions options) {
  const double length = 10;
  const double c = 30000;
  const double v = 30;
  const double forth_and_back = 2 * length / c;
  const double edge = length / cells;
  const Mesh mesh = test::block({0, edge}, test::even(0, length, cells), {0, edge});
  const double start = 0.3 * forth_and_back;
  const double dt = edge / c / steps_per_cell;
  const int n = static_cast<int>(std::lround(1.8 * forth_and_back / dt));
  options.density = {1e-9};
  options.velocity = Vec3(0, -v, 0);
  test::Moving bar(mesh, test::neo_hooke(0.15, 4), column_dofs(mesh, false), options,
                   {wall(mesh, v * start)}, dt, n);
  const double energy = bar.motion().kinetic;
  const double expected = 1e-9 * c * v * edge * edge;
  Pressure out;
  int counted = 0;
  for (int i = 1; i <= n; ++i) {
    bar.step();
    const double t = i * dt;
    const double p = bar.force() / expected;
    if (p > 0 && out.touch == 0) out.touch = t;
    if (p > 0) out.leave = t;
    const double share = (t - start) / forth_and_back;
    if (share < 0.075 || share > 0.93) continue;  // as in the table of the design
    out.mean += p;
    out.rms += (p - 1) * (p - 1);
    ++counted;
  }
  out.mean /= counted;
  out.rms = std::sqrt(out.rms / counted);
  out.energy = bar.energy() / energy - 1;
  out.touch = (out.touch - start) / forth_and_back;
  out.leave = (out.leave - start) / forth_and_back;
  MESSAGE("mean ", out.mean, " rms ", out.rms, " energy ", out.energy, " touch ", out.touch,
          " leave ", out.leave);
  return out;
}

InertiaOptions without_contact_mass(double rho_inf) {
  InertiaOptions options;
  options.rho_inf = rho_inf;
  options.massless = {1};  // sized and set for the candidates
  return options;
}

}  // namespace

TEST_CASE("a bar meets a wall with the pressure of its wave and leaves with its energy") {
  const int cells = 100;
  for (double steps : {1.0, 4.0}) {
    const Pressure found = bar_on_wall(cells, steps, without_contact_mass(1));
    CHECK(found.mean == near(1, 5e-3));
    CHECK(found.rms < (steps == 1 ? 0.01 : 0.05));
    CHECK(std::abs(found.energy) < 1e-3);
    CHECK(std::abs(found.touch) < 0.02);
    CHECK(found.leave == near(1, 0.02));
  }
}

// The table of docs/dynamics.md.
TEST_CASE("the pressure on a bar rings if contact nodes keep their mass") {
  const int cells = 50;
  InertiaOptions theta = without_contact_mass(1);
  theta.scheme = Scheme::theta;
  InertiaOptions kept;
  kept.rho_inf = 1;
  const Pressure moved_inwards = bar_on_wall(cells, 1, without_contact_mass(1));
  const Pressure impulses = bar_on_wall(cells, 1, theta);
  const Pressure ringing = bar_on_wall(cells, 1, kept);
  CHECK(moved_inwards.rms < 0.005);
  CHECK(impulses.rms < 0.005);
  CHECK(std::abs(impulses.energy) < 1e-4);
  CHECK(ringing.rms > 1);
  CHECK(ringing.energy > 1);
}

TEST_CASE("a mass on a light column bounces as on a spring") {
  const Mesh mesh = test::block({0, 1}, test::even(0, 4, 4), {0, 1});
  InertiaOptions options = without_contact_mass(1);
  const double m = 1e-6;     // 1 g
  const double v = 4;        // mm/s
  const double k = 0.9 / 4;  // N/mm
  options.density = {1e-13};
  options.travel_mass = m;
  options.travel_velocity = v;
  RigidContact punch;
  punch.name = "punch";
  punch.shape = Plane{{0, 4.001, 0}, {0, -1, 0}};
  punch.nodes = mesh.node_sets.at("y_max");
  punch.control = ForceControl{-Vec3::UnitY(), History{}, m, v};
  const double half_period = std::numbers::pi * std::sqrt(m / k);
  const int n = 300;
  const double dt = 2 * half_period / n;
  test::Moving column(mesh, test::neo_hooke(0.15, 4), column_dofs(mesh, true), options, {punch}, dt,
                      n);
  double peak = 0;
  int touching = 0;
  for (int i = 1; i <= n; ++i) {
    column.step();
    peak = std::max(peak, column.force());
    touching += column.force() > 0;
  }
  CHECK(peak == near(v * std::sqrt(m * k), 5e-3));
  CHECK(touching * dt == near(half_period, 1e-2));
  CHECK(column.motion().travel_v == near(-v, 2e-3));
  CHECK(std::abs(column.motion().balance) < 2e-3 * column.energy());
}
