// Iterative solution of large bodies: the split of the tangent, and results beside those of a
// factor. Without PETSc nothing is tried.
#include "mechanics/linear/mixed_tangent.hpp"

#include <doctest/doctest.h>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "mechanics/linear/petsc/petsc_load.hpp"
#include "support/indentation.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

bool petsc_is_here() {
  std::string why;
  if (petsc(why)) return true;
  MESSAGE("not tried: " << why);
  return false;
}

test::Indentation scene(double mu) {
  test::Indentation s;
  s.nx = s.nz = 14, s.ny = 4, s.h = 0.5, s.depth = 0.6, s.step = 0.2, s.mu = mu;
  s.newton.relative = 1e-9;
  return s;
}

// both ways: forces to 1e-8, displacements, closed gaps
void same_by_both(test::Indentation s, const Material& material) {
  s.newton.linear = LinearBy::direct;
  const auto direct = s.run(material);
  s.newton.linear = LinearBy::iterative;
  bool gave_up = false, iterative = false;
  s.after = [&](const Increment& increment, const Assembler&) {
    gave_up = gave_up || increment.gave_up_iterating(), iterative = increment.iterative();
  };
  const auto found = s.run(material);
  REQUIRE(direct.path.complete);
  REQUIRE(found.path.complete);
  CHECK(iterative);
  CHECK(!gave_up);
  REQUIRE(found.steps.size() == direct.steps.size());
  for (std::size_t i = 0; i < direct.steps.size(); ++i) {
    CHECK(found.steps[i].force == near(direct.steps[i].force, 1e-8));
    CHECK(found.steps[i].defect.penetration <= 1e-9);
    CHECK(found.steps[i].defect.status == direct.steps[i].defect.status);
  }
  CHECK((found.u - direct.u).lpNorm<Eigen::Infinity>() <=
        1e-8 * direct.u.lpNorm<Eigen::Infinity>());
}

}  // namespace

TEST_CASE("iterative: the tangent is what its two parts make") {
  if (!petsc_is_here()) return;
  const Mesh mesh =
      test::block(test::graded(2, 6, 0.3), test::even(0, 1.5, 3), test::even(-2, 2, 5));
  std::vector<Prescribed> held;
  for (int i : mesh.node_sets.at("y_min"))
    for (int k = 0; k < 3; ++k)
      if (k != 0 || i % 2 == 0) held.push_back({3 * i + k, 0});
  for (int i : mesh.node_sets.at("y_max")) held.push_back({3 * i + 1, -0.1});
  Assembler body = test::equilibrium(mesh, {test::table1(30, 1e-6)}, Formulation::mean_dilatation,
                                     number_dofs(mesh.n_nodes(), held).dofs);
  Random random(3);
  VecX u(body.dofs().n), du = VecX::Zero(body.dofs().n);
  for (double& x : u) x = 0.01 * (random.uniform() - 0.5);
  for (const Prescribed& p : body.dofs().prescribed) du[p.dof] = random.uniform();
  REQUIRE(body.assemble(u, true, &du));
  std::string why;
  const auto mixed = MixedTangent::of(body, 1, why);
  REQUIRE(mixed);
  mixed->linearise(body, du);
  VecX d(body.dofs().n_free());
  for (double& x : d) x = random.uniform() - 0.5;
  // K d = A d + B^T D B d, row by row
  const std::vector<double> A = mixed->rest_of(body);
  VecX by_parts = VecX::Zero(d.size());
  const Pattern& pattern = body.pattern();
  for (int column = 0; column < pattern.n; ++column)
    for (int at = pattern.column_start[column]; at < pattern.column_start[column + 1]; ++at) {
      by_parts[pattern.row[at]] += A[at] * d[column];
      if (pattern.row[at] != column) by_parts[column] += A[at] * d[pattern.row[at]];
    }
  const VecX Bd = mixed->solver().gather(mixed->b(), d);
  mixed->solver().spread(mixed->b(), mixed->D().cwiseProduct(Bd), by_parts);
  const VecX whole = body.K_times(d);
  CHECK((by_parts - whole).norm() <= 1e-12 * whole.norm());

  // of a solution, q = D B d + what is missing already, the pressures are those that the linearised
  // dilatation has
  const VecX q = mixed->D().cwiseProduct(Bd) + mixed->known_force();
  CHECK((mixed->known_strain() + q.cwiseQuotient(mixed->D()) - Bd).norm() <= 1e-12 * Bd.norm());
  const VecX before = body.volumetric_part().missing;
  VecX all = du;
  for (Eigen::Index row = 0; row < d.size(); ++row) all[body.dofs().free[row]] = d[row];
  const VecX dp = mixed->pressures(Bd, q);
  body.predict_pressures(all, 1);
  const VecX change = before - body.volumetric_part().missing;  // of the tangent's pressures
  CHECK((dp - change).norm() <= 1e-9 * change.norm());
}

TEST_CASE(
    "iterative: some ten products, on even and flat cells, with fibres, whatever the bulk modulus") {
  if (!petsc_is_here()) return;
  for (const bool flat : {false, true})
    for (const Material& material :
         {test::neo_hooke(0.05, 1e-8), test::neo_hooke(0.05, 1e-3), test::neo_hooke(0.05, 20),
          test::stable(30, 1e-6), test::table1(60, 1e-6)}) {
      const auto along = flat ? test::graded(15, 16, 0.2) : test::even(-4, 4, 12);
      const Mesh mesh = test::block(along, test::even(0, 4, 6), along);
      std::vector<Prescribed> held;
      for (int i : mesh.node_sets.at("y_min"))
        for (int k = 0; k < 3; ++k) held.push_back({3 * i + k, 0});
      Assembler body = test::equilibrium(mesh, {material}, Formulation::mean_dilatation,
                                         number_dofs(mesh.n_nodes(), held).dofs);
      const VecX rest = VecX::Zero(body.dofs().n);
      REQUIRE(body.assemble(rest, true));
      std::string why;
      const auto mixed = MixedTangent::of(body, 1, why);
      REQUIRE(mixed);
      mixed->linearise(body, rest);
      VecX f = VecX::Zero(body.dofs().n_free());  // pressed on a patch
      for (int i : mesh.node_sets.at("y_max"))
        if (mesh.X[i].head<1>().norm() < 1.5 && std::abs(mesh.X[i][2]) < 1.5)
          f[body.dofs().equation[3 * i + 1]] = -0.01;
      ContactInTangent nothing(body, {}, 1);
      VecX dp;
      const std::vector<RigidContact> none;
      const std::vector<VecX> no_start;
      const std::vector<Vec3> no_move;
      const Reactions no_reactions;
      const auto found = nothing.solve(
          {none, mesh.X, rest, no_start, no_move, no_move, no_reactions}, body, f, *mixed, dp);
      REQUIRE(found);
      CHECK(found->solutions <= 20);
      LinearSolver direct(body.pattern());
      REQUIRE(direct.factorize(body.K()));
      const VecX wanted = direct.solve(f);
      CHECK((found->move - wanted).norm() <= 1e-2 * wanted.norm());
    }
}

TEST_CASE("iterative: forces of a factor, without friction and with it") {
  if (!petsc_is_here()) return;
  same_by_both(scene(0), test::neo_hooke(0.05, 1e-6));
  same_by_both(scene(0.34), test::neo_hooke(0.05, 1e-3));
}

TEST_CASE("iterative: forces of a factor with the paper's law") {
  if (!petsc_is_here()) return;
  same_by_both(scene(0.34), test::table1(60, 1e-6));
}

TEST_CASE("iterative: a law that is hardly resisted in volume, and one with stiff fibres") {
  if (!petsc_is_here()) return;
  same_by_both(scene(0.1), test::neo_hooke(0.05, 2));
  same_by_both(scene(0.1), test::stable(45, 1e-8));
}

TEST_CASE(
    "iterative: another indenter, away from the middle, on a quarter, over a base that glides") {
  if (!petsc_is_here()) return;
  test::Indentation s = scene(0.2);
  s.shape = Plane{{0, 4, 0}, {0, 1, 0}}, s.reach = 3, s.depth = 0.2, s.step = 0.1;
  same_by_both(s, test::neo_hooke(0.05, 1e-5));
  s = scene(0.5);
  s.motion = {{0.5, Vec3(0, -0.4, 0)}, {1, Vec3(0.6, -0.4, 0.1)}}, s.depth = 1;
  same_by_both(s, test::neo_hooke(0.05, 1e-5));
  s = scene(0.3);
  s.quarter = true;
  same_by_both(s, test::neo_hooke(0.05, 1e-5));
}

// Off the indenter the forces vanish, and what is left of the volume outweighs them.
TEST_CASE("iterative: an indenter that leaves the body needs no shorter increments") {
  if (!petsc_is_here()) return;
  test::Indentation s;
  s.nx = s.nz = 14, s.ny = 4, s.h = 0.5, s.mu = 0.34;
  s.motion = {{0.5, Vec3(0, -0.8, 0)}, {1, Vec3(0, 0.1, 0)}};
  s.depth = 1, s.step = 0.125;
  s.newton.linear = LinearBy::iterative;
  const auto found = s.run(test::table1(60, 1e-6));
  REQUIRE(found.path.complete);
  CHECK(found.path.steps == 8);
  CHECK(found.path.cut_backs == 0);
  CHECK(found.steps.back().force == 0);
}

// A body that its law turns against itself has no such solution; whoever asks for one gets what a
// factor gives.
TEST_CASE("iterative: what does not converge is left to a factor") {
  if (!petsc_is_here()) return;
  const Mesh mesh = test::block(test::even(0, 1, 2), test::even(0, 1, 2), test::even(0, 1, 2));
  std::vector<Prescribed> held;
  for (int i : mesh.node_sets.at("y_min"))
    for (int k = 0; k < 3; ++k) held.push_back({3 * i + k, 0});
  for (int i : mesh.node_sets.at("y_max")) held.push_back({3 * i, 0.01});
  Assembler body =
      test::equilibrium(mesh, {test::neo_hooke(-0.05, 1)}, Formulation::mean_dilatation,
                        number_dofs(mesh.n_nodes(), held).dofs);
  const auto solved = [&](LinearBy linear_by) {
    IncrementOptions options;
    options.linear_by = linear_by;
    Increment increment(body, {}, options);
    CHECK(increment.iterative() == (linear_by == LinearBy::iterative));
    increment.begin(1);
    CHECK(newton(increment.problem(), increment.trial(), {}).converged());
    CHECK(increment.gave_up_iterating() == (linear_by == LinearBy::iterative));
    return increment.trial();
  };
  const VecX direct = solved(LinearBy::direct), left = solved(LinearBy::iterative);
  CHECK((direct - left).norm() <= 1e-9 * direct.norm());
}

TEST_CASE("iterative: the same digits twice") {
  if (!petsc_is_here()) return;
  test::Indentation s = scene(0.34);
  s.newton.linear = LinearBy::iterative;
  const auto once = s.run(test::table1(60, 1e-6)), again = s.run(test::table1(60, 1e-6));
  CHECK(once.u == again.u);
}

TEST_CASE("iterative: what it is not for is refused where asked for, and factorized where not") {
  if (!petsc_is_here()) return;
  test::Indentation s = scene(0);
  s.depth = s.step = 0.1;
  s.cells = CellType::hex27, s.nx = s.nz = 6, s.ny = 2;
  s.newton.linear = LinearBy::iterative;
  CHECK_THROWS_AS(s.run(test::neo_hooke(0.05, 1e-3)), Failure);
  s.newton.linear = LinearBy::automatic;
  CHECK(s.run(test::neo_hooke(0.05, 1e-3)).path.complete);
}
