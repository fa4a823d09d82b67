// A smooth displacement chosen first, the body force that balances it computed from the law, the mesh refined:
// the error of u must fall with h^2.
#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>

#include "solve/statics.hpp"
#include "support/block.hpp"
#include "support/laws.hpp"
#include "tensor/voigt.hpp"

using namespace langer;

namespace {

constexpr double pi = 3.14159265358979323846;

Vec3 chosen(const Vec3& X) {
  return 0.05 *
         Vec3(std::sin(pi * X[0]) * std::cos(X[1] + X[2]), std::sin(2 * X[1]) * X[0] * X[0], std::cos(2 * X[2] - X[0]) * X[1]);
}

Mat3 gradient(const Vec3& X) {
  Mat3 H;
  const double h = 1e-5;
  for (int j = 0; j < 3; ++j) H.col(j) = (chosen(X + h * Vec3::Unit(j)) - chosen(X - h * Vec3::Unit(j))) / (2 * h);
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
    const auto P = [&](double s) { return Vec3(first_piola(material, X + s * h * Vec3::Unit(j)).col(j)); };
    b -= (8 * (P(1) - P(-1)) - (P(2) - P(-2))) / (12 * h);
  }
  return b;
}

double error_of(Formulation formulation, const Material& material, int n) {
  const Mesh mesh = test::cube(n);
  std::vector<Prescribed> outer;
  std::vector<char> seen(mesh.n_nodes(), 0);
  for (const auto& [name, nodes] : mesh.node_sets)
    for (int i : nodes)
      if (!seen[i]++)
        for (int k = 0; k < 3; ++k) outer.push_back({3 * i + k, chosen(mesh.X[i])[k]});
  Equilibrium body(mesh, {material}, formulation, number_dofs(mesh.n_nodes(), outer).dofs);
  VecX F = VecX::Zero(3 * mesh.n_nodes());
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int g = 0; g < 8; ++g) {
      const Hex8::Shape N = Hex8::shape(Hex8::gauss(g));
      const Vec3 b = body_force(material, element_nodes(mesh, e).transpose() * N) * body.geometry(e).w[g];
      for (int a = 0; a < 8; ++a) F.segment<3>(3 * mesh.cell(e)[a]) += N[a] * b;
    }
  Statics statics(body, {}, {});
  statics.set_dead_load(F);
  statics.begin(1);
  REQUIRE(newton(statics.problem(), statics.trial(), {}).converged());
  double square = 0;
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int g = 0; g < 8; ++g) {
      const Hex8::Shape N = Hex8::shape(Hex8::gauss(g));
      const Vec3 X = element_nodes(mesh, e).transpose() * N, u = body.element_displacements(statics.trial(), e).transpose() * N;
      square += body.geometry(e).w[g] * (u - chosen(X)).squaredNorm();
    }
  return std::sqrt(square);
}

}  // namespace

TEST_CASE("the error of u falls with the square of the element size: order 2 within 0.1 between the finest meshes") {
  for (Formulation formulation : {Formulation::mean_dilatation, Formulation::displacement}) {
    const Material material = test::stable(35, 1.0);
    double last = error_of(formulation, material, 2);
    for (int n : {4, 8, 16}) {
      const double error = error_of(formulation, material, n);
      const double order = std::log2(last / error);
      MESSAGE("n " << n << ": error " << error << " mm, order " << order);
      if (n == 16) CHECK(std::abs(order - 2) < 0.1);
      last = error;
    }
  }
}
