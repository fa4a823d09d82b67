// What the cells show of a body's stability is what a factor of its tangent shows.
#include "mechanics/solve/cell_stability.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "mechanics/solve/increment.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"

using namespace langer;

namespace {

constexpr double a1 = 0.1, d = 1e-2;  // [MPa], [1/MPa]

struct Looked {
  bool cells = false;
  Signature by_factor, by_cells;
};

// a block stretched by a homogeneous deformation, its bottom held
Looked look(const Mat3& H) {
  const Mesh mesh = test::block(test::even(0, 8, 8), test::even(0, 2, 2), test::even(0, 2, 2));
  std::vector<Prescribed> held;
  for (int node : mesh.node_sets.at("x_min"))
    for (int k = 0; k < 3; ++k) held.push_back({3 * node + k, 0});
  const auto dofs = number_dofs(mesh.n_nodes(), held).dofs;
  BodyState state;
  state.t = 1;
  state.u = VecX::Zero(3 * mesh.n_nodes());
  for (int node = 0; node < mesh.n_nodes(); ++node)
    state.u.segment<3>(3 * node) = H * mesh.X[static_cast<std::size_t>(node)];
  Looked looked;
  for (const bool from_cells : {false, true}) {
    Assembler body =
        test::equilibrium(mesh, {test::neo_hooke(a1, d)}, Formulation::mean_dilatation, dofs);
    IncrementOptions options;
    options.signs_from_cells = from_cells;
    Increment increment(body, {}, options);
    increment.restore(state);
    body.pressures_from(state.u);
    (from_cells ? looked.by_cells : looked.by_factor) = increment.signature();
    looked.cells = every_cell_resists(body, state.u);
  }
  return looked;
}

// Stretched along x and y by the material, free of stress along z.
Mat3 stretched(double x, double y) {
  const double modulus = 2 * a1, bulk = 2 / d;
  double J = 1;
  for (int i = 0; i < 50; ++i) {
    const double z = J / (x * y), mean = (x * x + y * y + z * z) / 3;
    J = 1 + modulus * std::pow(J, -5. / 3) * (mean - z * z) / bulk;
  }
  return Vec3(x - 1, y - 1, J / (x * y) - 1).asDiagonal();
}

// along x only
Mat3 stretched(double x) {
  double y = 1 / std::sqrt(x);
  for (int i = 0; i < 50; ++i) y = std::sqrt(y * (1 + stretched(x, y)(2, 2)));
  return stretched(x, y);
}

}  // namespace

TEST_CASE("a bar in tension is shown to be stable by its cells, one in compression is not") {
  for (double stretch : {1.0, 1.01, 1.2, 2.0}) {
    CAPTURE(stretch);
    const Looked looked = look(stretched(stretch));
    CHECK(looked.cells);
    CHECK(looked.by_factor.negative == 0);
    CHECK(looked.by_cells.negative == 0);
  }
  for (double stretch : {0.99, 0.8, 0.5}) {
    CAPTURE(stretch);
    const Looked looked = look(stretched(stretch));
    CHECK_FALSE(looked.cells);
    CHECK(looked.by_cells.negative == looked.by_factor.negative);
  }
  CHECK(look(stretched(0.5)).by_cells.negative > 0);  // it buckles
}

TEST_CASE("cells never show a body to be stable whose factor has negative pivots") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> of(-0.7, 0.7);
  int shown = 0, unstable = 0;
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const double x = 1.2 + of(random), y = 1.2 + of(random);
    const Looked looked = look(i % 2 == 0 ? stretched(x) : stretched(x, y));
    CHECK(looked.by_cells.negative == looked.by_factor.negative);
    if (looked.cells) ++shown;
    if (looked.by_factor.negative > 0) ++unstable;
  }
  CHECK(shown >= 10);
  CHECK(unstable >= 3);
}

TEST_CASE("a cell does not stand for another one with other fibres") {
  const Mesh mesh = test::block({0, 1, 2}, {0, 1}, {0, 1});
  // Fibres that lose stiffness where they are stretched; those across are shortened and do nothing.
  Material material = test::neo_hooke(a1, d);
  material.fibres.push_back({HgoFibre{-5, 1}, 0});
  const auto resists = [&](const Vec3& of_second) {
    Directions directions(true);
    directions.append({Vec3::UnitY()});
    directions.append({of_second});
    const Assembler body(mesh, {material}, directions, Formulation::mean_dilatation,
                         number_dofs(mesh.n_nodes(), {}).dofs);
    VecX u(3 * mesh.n_nodes());
    for (int node = 0; node < mesh.n_nodes(); ++node)
      u.segment<3>(3 * node) = stretched(1.2) * mesh.X[static_cast<std::size_t>(node)];
    return every_cell_resists(body, u);
  };
  CHECK(resists(Vec3::UnitY()));
  CHECK_FALSE(resists(Vec3::UnitX()));
}
