// The bar of Doyen, Ern and Piperno [2011] on a wall, for tests and for `langer-bench motion`.
#pragma once

#include <cmath>

#include "dynamics/moving.hpp"

namespace langer::test {

// Sides held across: a column in one-dimensional strain, with the modulus K + 4 G / 3.
inline Dofs column_dofs(const Mesh& mesh, bool clamped) {
  std::vector<Prescribed> held;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    held.push_back({3 * i, 0});
    held.push_back({3 * i + 2, 0});
    if (clamped && mesh.X[i][1] == 0) held.push_back({3 * i + 1, 0});
  }
  return number_dofs(mesh.n_nodes(), held).dofs;
}

inline RigidContact wall(const Mesh& mesh, double gap, double mu = 0) {
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
inline Pressure bar_on_wall(int cells, double steps_per_cell, InertiaOptions options) {
  const double length = 10;
  const double c = 30000;
  const double v = 30;
  const double forth_and_back = 2 * length / c;
  const double edge = length / cells;
  const Mesh mesh = block({0, edge}, even(0, length, cells), {0, edge});
  const double start = 0.3 * forth_and_back;
  const double dt = edge / c / steps_per_cell;
  const int n = static_cast<int>(std::lround(1.8 * forth_and_back / dt));
  options.density = {1e-9};
  options.velocity = Vec3(0, -v, 0);
  Moving bar(mesh, neo_hooke(0.15, 4), column_dofs(mesh, false), options, {wall(mesh, v * start)},
             dt, n);
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
  return out;
}

}  // namespace langer::test
