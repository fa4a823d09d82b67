// A smooth displacement chosen first, the body force that balances it computed from the law, the
// mesh refined: the error of u must fall with h^2 in hex8, with h^3 in hex27 and tet15 with linear
// dilatation, and there that of the stress with h^2.
#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>

#include "core/tensor/voigt.hpp"
#include "mechanics/assembly/assembler.hpp"
#include "mechanics/linear/linear.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"

using namespace langer;

namespace {

constexpr double pi = 3.14159265358979323846;

Vec3 chosen(const Vec3& X) {
  return 0.05 * Vec3(std::sin(pi * X[0]) * std::cos(X[1] + X[2]), std::sin(2 * X[1]) * X[0] * X[0],
                     std::cos(2 * X[2] - X[0]) * X[1]);
}

Mat3 gradient(const Vec3& X) {
  Mat3 H;
  const double h = 1e-5;
  for (int j = 0; j < 3; ++j)
    H.col(j) = (chosen(X + h * Vec3::Unit(j)) - chosen(X - h * Vec3::Unit(j))) / (2 * h);
  return H;
}

Mat3 first_piola(const Material& material, const Vec3& X) {
  const Mat3 F = Mat3::Identity() + gradient(X);
  return F * tensor(response(material, F.transpose() * F, fibre_directions(material)).S);
}

Vec3 body_force(const Material& material, const Vec3& X) {  // -Div P
  Vec3 b = Vec3::Zero();
  const double h = 1e-3;  // fourth order
  for (int j = 0; j < 3; ++j) {
    const auto P = [&](double s) {
      return Vec3(first_piola(material, X + s * h * Vec3::Unit(j)).col(j));
    };
    b -= (8 * (P(1) - P(-1)) - (P(2) - P(-2))) / (12 * h);
  }
  return b;
}

// u under nodal forces F, by Newton's method from the chosen displacements
VecX balanced(Assembler& body, const VecX& F) {
  const Dofs& dofs = body.dofs();
  VecX u(dofs.n);
  for (int n = 0; n < body.mesh().n_nodes(); ++n) u.segment<3>(3 * n) = chosen(body.mesh().X[n]);
  LinearSolver solver(body.pattern());
  for (int k = 0; k < 12; ++k) {
    body.pressures_from(u);
    REQUIRE(body.assemble(u, true));
    const VecX r = (F - body.f_int())(dofs.free);
    if (r.norm() < 1e-10 * F.norm()) return u;
    REQUIRE(solver.factorize(body.K()));
    const VecX du = solver.solve(r);
    for (int row = 0; row < dofs.n_free(); ++row) u[dofs.free[row]] += du[row];
  }
  FAIL("Newton's method does not converge");
  return u;
}

struct Errors {
  double u, sigma;  // [mm], [MPa]; norms over the cube
};

Errors errors_of(CellType cells, Formulation formulation, const Material& material, int n) {
  const Mesh mesh =
      cells == CellType::hex8 ? test::cube(n) : test::raised_block(test::cube(n), cells);
  const ReferenceCell& cell = reference(nodes_per_cell(cells));
  std::vector<Prescribed> outer;
  std::vector<char> seen(mesh.n_nodes(), 0);
  for (const auto& [name, nodes] : mesh.node_sets)
    for (int i : nodes)
      if (!seen[i]++)
        for (int k = 0; k < 3; ++k) outer.push_back({3 * i + k, chosen(mesh.X[i])[k]});
  Assembler body =
      test::equilibrium(mesh, {material}, formulation, number_dofs(mesh.n_nodes(), outer).dofs);
  VecX F = VecX::Zero(3 * mesh.n_nodes());
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int g = 0; g < cell.n_gauss; ++g) {
      const VecX& N = cell.N[g];
      const Vec3 b =
          body_force(material, element_nodes(mesh, e).transpose() * N) * body.geometry(e).w[g];
      for (int a = 0; a < cell.n_nodes; ++a) F.segment<3>(3 * mesh.cell(e)[a]) += N[a] * b;
    }
  const VecX found = balanced(body, F);
  double square = 0, stress = 0;
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const ElementNodes q = body.element_displacements(found, e);
    const auto states = gauss_states(formulation, material, body.geometry(e), body.fibres(e), q);
    for (int g = 0; g < cell.n_gauss; ++g) {
      const Vec3 X = element_nodes(mesh, e).transpose() * cell.N[g], u = q.transpose() * cell.N[g];
      const Mat3 F = Mat3::Identity() + gradient(X),
                 sigma = first_piola(material, X) * F.transpose() / F.determinant();
      square += body.geometry(e).w[g] * (u - chosen(X)).squaredNorm();
      stress += body.geometry(e).w[g] * (states[g].sigma - sigma).squaredNorm();
    }
  }
  return {std::sqrt(square), std::sqrt(stress)};
}

// orders between two meshes
Errors orders(CellType cells, Formulation formulation, std::array<int, 2> n) {
  const Material material = test::stable(35, 1);
  const Errors coarse = errors_of(cells, formulation, material, n[0]),
               fine = errors_of(cells, formulation, material, n[1]);
  const double refined = std::log2(static_cast<double>(n[1]) / n[0]);
  const Errors order{std::log2(coarse.u / fine.u) / refined,
                     std::log2(coarse.sigma / fine.sigma) / refined};
  MESSAGE(std::string(names(formulation)[static_cast<int>(formulation)])
          << ", n " << n[1] << ": errors " << fine.u << " mm, " << fine.sigma << " MPa, orders "
          << order.u << ", " << order.sigma);
  return order;
}

}  // namespace

TEST_CASE(
    "hex8: the error of u falls with the square of the element size: order 2 within 0.1 between the finest meshes") {
  for (Formulation formulation : {Formulation::mean_dilatation, Formulation::displacement})
    CHECK(std::abs(orders(CellType::hex8, formulation, {8, 16}).u - 2) < 0.1);
}

TEST_CASE("hex27: order 3 in u and 2 in stress with linear dilatation, less with a constant one") {
  const Errors linear = orders(CellType::hex27, Formulation::linear_dilatation, {4, 8});
  CHECK(linear.u > 2.9);
  CHECK(std::abs(linear.sigma - 2) < 0.1);
  const Errors constant = orders(CellType::hex27, Formulation::mean_dilatation, {4, 8});
  CHECK(constant.sigma < 1.5);
}

TEST_CASE("tet15: order 3 in u and 2 in stress") {
  const Errors order = orders(CellType::tet15, Formulation::linear_dilatation, {3, 6});
  CHECK(order.u > 2.8);
  CHECK(order.sigma > 1.8);
}
