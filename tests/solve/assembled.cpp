// The assembled tangent: every entry goes to its place, however nodes are held.
#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "mechanics/assembly/assembler.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"

using namespace langer;

namespace {

using Entries = std::map<std::pair<int, int>, double>;  // by dofs, the greater first

Entries entries(const Assembler& body) {
  Entries out;
  const Pattern& pattern = body.pattern();
  const std::vector<int>& free = body.dofs().free;
  for (int c = 0; c < pattern.n; ++c)
    for (int k = pattern.column_start[c]; k < pattern.column_start[c + 1]; ++k)
      out[{std::max(free[c], free[pattern.row[k]]), std::min(free[c], free[pattern.row[k]])}] =
          body.K()[k];
  return out;
}

VecX some_state(const Mesh& mesh) {
  VecX u(3 * mesh.n_nodes());
  for (Eigen::Index i = 0; i < u.size(); ++i) u[i] = 0.03 * std::sin(1.7 * static_cast<double>(i));
  return u;
}

}  // namespace

TEST_CASE(
    "the tangent of a body with held nodes is the part of the free body's tangent that is left") {
  Mesh block = test::block(test::even(0, 3, 3), test::even(0, 2, 2), test::even(0, 3, 3));
  block.body.assign(block.n_cells(), 0), block.bodies = {"skin", "other"};
  for (int e = 0; e < block.n_cells(); e += 3)
    block.body[e] = 1;  // the order of the sums is not that of the cells
  for (CellType type : {CellType::hex8, CellType::hex27}) {
    const Mesh mesh = type == CellType::hex8 ? block : test::raised_block(block, type);
    const std::vector<Material> materials = {test::table1(60, 1e-3), test::table1(20, 1e-3)};
    const VecX u = some_state(mesh);
    Assembler whole = test::equilibrium(mesh, materials, usual_formulation(type),
                                        number_dofs(mesh.n_nodes(), {}).dofs);
    REQUIRE(whole.assemble(u, true));
    const Entries all = entries(whole);
    for (int held : {0, 1, 2, 3}) {  // nothing, whole nodes, single directions, both
      CAPTURE(held);
      std::vector<Prescribed> prescribed;
      for (int i = 0; i < mesh.n_nodes(); ++i) {
        if ((held == 1 || held == 3) && i % 5 == 0)
          for (int k = 0; k < 3; ++k) prescribed.push_back({3 * i + k, 0});
        if (held >= 2 && i % 7 == 3) prescribed.push_back({3 * i + i % 3, 0});
      }
      Assembler body = test::equilibrium(mesh, materials, usual_formulation(type),
                                         number_dofs(mesh.n_nodes(), prescribed).dofs);
      for (int again = 0; again < 2; ++again) {  // K is written over, not added to
        REQUIRE(body.assemble(u, true));
        double worst = 0, largest = 0;
        for (const auto& [dofs, K] : entries(body)) {
          worst = std::max(worst, std::abs(K - all.at(dofs)));
          largest = std::max(largest, std::abs(K));
        }
        CHECK(worst <= 1e-13 * largest);
        CHECK(largest > 1);
      }
    }
  }
}

TEST_CASE(
    "the forces of displacements still to be imposed are the derivative of the body's forces along them") {
  Mesh block = test::block(test::even(0, 3, 3), test::even(0, 2, 2), test::even(0, 3, 3));
  for (CellType type : {CellType::hex8, CellType::hex27}) {
    const Mesh mesh = type == CellType::hex8 ? block : test::raised_block(block, type);
    const VecX u = some_state(mesh);
    VecX du = VecX::Zero(u.size());
    std::vector<Prescribed> prescribed;
    for (int i = 0; i < mesh.n_nodes(); i += 4) {
      const int dof = 3 * i + i % 3;
      prescribed.push_back({dof, u[dof] + 0.01 * (1 + i % 5)}), du[dof] = 0.01 * (1 + i % 5);
    }
    Assembler body = test::equilibrium(mesh, {test::stable(60, 1e-2)}, Formulation::displacement,
                                       number_dofs(mesh.n_nodes(), prescribed).dofs);
    body.pressures_from(u);
    REQUIRE(body.assemble(u, true, &du));
    const VecX K_du = body.K_du();
    const double h = 1e-4;
    REQUIRE(body.assemble(u + h * du, false));
    const VecX ahead = body.f_int();
    REQUIRE(body.assemble(u - h * du, false));
    const VecX difference = (ahead - body.f_int()) / (2 * h);
    CHECK((K_du - difference).norm() < 1e-5 * difference.norm());
    CHECK(difference.norm() > 0);
  }
}

TEST_CASE(
    "the floor of the residual is what rounding of the displacements does to the forces, within a factor of 30") {
  const Mesh mesh = test::block(test::even(0, 3, 3), test::even(0, 2, 2), test::even(0, 3, 3));
  for (double d : {1e-6, 1e-9}) {
    Assembler body = test::equilibrium(mesh, {test::stable(60, d)}, Formulation::mean_dilatation,
                                       number_dofs(mesh.n_nodes(), {}).dofs);
    const auto forces = [&](const VecX& u) {
      body.pressures_from(u);
      REQUIRE(body.assemble(u, false));
      return VecX(body.f_int());
    };
    const VecX u = some_state(mesh);
    VecX rounded = u;
    for (Eigen::Index i = 0; i < u.size(); ++i)
      rounded[i] = std::nextafter(u[i], i % 3 == 1 ? -1.0 : 1.0);
    const double moved = (forces(rounded) - forces(u)).norm(), floor = body.rounding_floor();
    CAPTURE(moved / floor);
    CHECK(floor < 30 * moved);
    CHECK(moved < 30 * floor);
  }
}
