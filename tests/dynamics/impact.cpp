// Impact: a bar on a wall and an indenter with mass on a column.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "dynamics/bar_on_wall.hpp"
#include "dynamics/moving.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

InertiaOptions without_contact_mass(double rho_inf) {
  InertiaOptions options;
  options.rho_inf = rho_inf;
  options.massless = {1};  // sized and set for the candidates
  return options;
}

// A plane with a mass that comes down on a column from a height.
RigidContact heavy_punch(const Mesh& mesh, double mass, double velocity, double height) {
  RigidContact punch;
  punch.name = "punch";
  punch.shape = Plane{{0, height, 0}, {0, -1, 0}};
  punch.nodes = mesh.node_sets.at("y_max");
  punch.control = ForceControl{-Vec3::UnitY(), History{}, mass, velocity};
  return punch;
}

}  // namespace

TEST_CASE("a bar meets a wall with the pressure of its wave and leaves with its energy") {
  const int cells = 100;
  for (double steps : {1.0, 4.0}) {
    const test::Pressure found = test::bar_on_wall(cells, steps, without_contact_mass(1));
    MESSAGE("mean ", found.mean, " rms ", found.rms, " energy ", found.energy);
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
  const test::Pressure moved_inwards = test::bar_on_wall(cells, 1, without_contact_mass(1));
  const test::Pressure impulses = test::bar_on_wall(cells, 1, theta);
  const test::Pressure ringing = test::bar_on_wall(cells, 1, kept);
  CHECK(moved_inwards.rms < 0.005);
  CHECK(impulses.rms < 0.005);
  CHECK(std::abs(impulses.energy) < 1e-4);
  CHECK(ringing.rms > 1);
  CHECK(ringing.energy > 1);
}

// Nodes without mass move as the increment does, so their acceleration is nowhere.
TEST_CASE("a mass on a light column bounces as on a spring") {
  for (Scheme scheme : {Scheme::generalised_alpha, Scheme::theta}) {
    const Mesh mesh = test::block({0, 1}, test::even(0, 4, 4), {0, 1});
    InertiaOptions options = without_contact_mass(1);
    options.scheme = scheme;
    const double m = 1e-6;     // 1 g
    const double v = 4;        // mm/s
    const double k = 0.9 / 4;  // N/mm
    options.density = {1e-13};
    options.travel_mass = m;
    options.travel_velocity = v;
    const RigidContact punch = heavy_punch(mesh, m, v, 4.001);
    const double half_period = std::numbers::pi * std::sqrt(m / k);
    const int n = 300;
    const double dt = 2 * half_period / n;
    test::Moving column(mesh, test::neo_hooke(0.15, 4), test::column_dofs(mesh, true), options,
                        {punch}, dt, n);
    double peak = 0;
    int touching = 0;
    for (int i = 1; i <= n; ++i) {
      const VecX before = column.increment().accepted().u;
      column.step();
      peak = std::max(peak, column.force());
      touching += column.force() > 0;
      const VecX moved = column.increment().accepted().u - before;
      for (int node : punch.nodes) {
        CHECK(column.motion().v[3 * node + 1] == near(moved[3 * node + 1] / dt, 1e-12));
        CHECK(column.motion().a[3 * node + 1] == 0);
      }
    }
    CHECK(peak == near(v * std::sqrt(m * k), 5e-3));
    CHECK(touching * dt == near(half_period, 1e-2));
    CHECK(column.motion().travel_v == near(-v, 2e-3));
    CHECK(std::abs(column.motion().balance) < 2e-3 * column.energy());
  }
}

TEST_CASE("an indenter with a mass falls by v t + g t^2 / 2 before it touches") {
  for (Scheme scheme : {Scheme::generalised_alpha, Scheme::theta}) {
    for (double rho_inf : {0.5, 1.0}) {
      const Mesh mesh = test::block({0, 1}, {0, 4}, {0, 1});
      InertiaOptions options = without_contact_mass(rho_inf);
      options.scheme = scheme;
      const double m = 2e-6;
      const double v = 30;    // mm/s
      const double g = 9810;  // mm/s^2
      options.travel_mass = m;
      options.travel_velocity = v;
      options.travel_weight = m * g;
      const int n = 5;
      const double time = 0.02;
      test::Moving fall(mesh, test::neo_hooke(0.15, 4), test::column_dofs(mesh, true), options,
                        {heavy_punch(mesh, m, v, 14)}, time / n, n);
      for (int i = 0; i < n; ++i) fall.step();
      CHECK(fall.increment().accepted().travel == near(v * time + 0.5 * g * time * time, 1e-9));
      CHECK(fall.motion().travel_v == near(v + g * time, 1e-9));
      CHECK(std::abs(fall.motion().balance) < 1e-9 * fall.energy());
    }
  }
}
