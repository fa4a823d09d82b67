// Element tests: patch, rigid motion, tangent, both formulations.
#include "element/solid.hpp"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "assembly/equilibrium.hpp"
#include "support/block.hpp"
#include "support/laws.hpp"
#include "tensor/stress.hpp"

using namespace langer;

namespace {

struct One {
  ElementNodes X;
  ElementGeometry geometry;
  std::vector<Vec3> a;
  Material material;
};

One distorted(double d, unsigned seed = 5) {
  One one;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-0.15, 0.15);
  for (int n = 0; n < 8; ++n)
    for (int k = 0; k < 3; ++k) one.X(n, k) = 0.5 * Hex8::corner[n][k] + u(random);
  one.geometry = element_geometry(one.X);
  one.material = test::stable(30, d);
  one.a = fibre_directions(one.material);
  return one;
}

ElementNodes some_displacement(unsigned seed, double size) {
  ElementNodes u;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> r(-size, size);
  for (auto& v : u.reshaped()) v = r(random);
  return u;
}

const Formulation formulations[] = {Formulation::mean_dilatation, Formulation::displacement};

}  // namespace

TEST_CASE("the internal force is the gradient of the stored energy") {
  const One one = distorted(1e-2);
  for (Formulation formulation : formulations) {
    const ElementNodes u = some_displacement(1, 0.1);
    SolidElement at, plus, minus;
    REQUIRE(solid(formulation, one.material, one.geometry, one.a, u, nullptr, false, at));
    const double h = 1e-6, scale = at.f.lpNorm<Eigen::Infinity>();
    for (int i = 0; i < 24; ++i) {
      ElementNodes up = u, down = u;
      up(i / 3, i % 3) += h, down(i / 3, i % 3) -= h;
      solid(formulation, one.material, one.geometry, one.a, up, nullptr, false, plus);
      solid(formulation, one.material, one.geometry, one.a, down, nullptr, false, minus);
      CHECK(std::abs((plus.W - minus.W) / (2 * h) - at.f[i]) <= 1e-7 * scale);
    }
  }
}

TEST_CASE("the tangent is the derivative of the force, and symmetric") {
  for (double d : {1.0, 1e-2, 1e-4}) {
    const One one = distorted(d);
    for (Formulation formulation : formulations) {
      const ElementNodes u = some_displacement(2, 0.1);
      SolidElement at, plus, minus;
      REQUIRE(solid(formulation, one.material, one.geometry, one.a, u, nullptr, true, at));
      const double scale = at.K.lpNorm<Eigen::Infinity>(), h = 3e-6;
      CHECK((at.K - at.K.transpose()).lpNorm<Eigen::Infinity>() <= 1e-13 * scale);
      for (int j = 0; j < 24; ++j) {
        ElementNodes up = u, down = u;
        up(j / 3, j % 3) += h, down(j / 3, j % 3) -= h;
        solid(formulation, one.material, one.geometry, one.a, up, nullptr, false, plus);
        solid(formulation, one.material, one.geometry, one.a, down, nullptr, false, minus);
        CHECK(((plus.f - minus.f) / (2 * h) - at.K.col(j)).lpNorm<Eigen::Infinity>() <= 1e-7 * scale);
      }
    }
  }
}

TEST_CASE("the dilatation's gradient is its derivative") {
  const One one = distorted(1e-2);
  for (Formulation formulation : formulations) {
    const ElementNodes u = some_displacement(3, 0.1);
    SolidElement at, plus, minus;
    solid(formulation, one.material, one.geometry, one.a, u, nullptr, false, at);
    const double h = 1e-6;
    for (int j = 0; j < 24; ++j) {
      ElementNodes up = u, down = u;
      up(j / 3, j % 3) += h, down(j / 3, j % 3) -= h;
      solid(formulation, one.material, one.geometry, one.a, up, nullptr, false, plus);
      solid(formulation, one.material, one.geometry, one.a, down, nullptr, false, minus);
      for (int k = 0; k < n_pressures(formulation); ++k)
        CHECK((plus.J_minus_1[k] - minus.J_minus_1[k]) / (2 * h) == doctest::Approx(at.dJ_du[k][j]).epsilon(1e-7).scale(1));
    }
  }
}

TEST_CASE("a rigid rotation costs nothing and K has six zero eigenvalues, no more") {
  const One one = distorted(1e-2);
  for (Formulation formulation : formulations) {
    SolidElement rest;
    solid(formulation, one.material, one.geometry, one.a, ElementNodes::Zero(), nullptr, true, rest);
    const Eigen::SelfAdjointEigenSolver<Mat24> eigen(rest.K);
    const double largest = eigen.eigenvalues()[23];
    int zeros = 0;
    for (double value : eigen.eigenvalues()) zeros += std::abs(value) < 1e-12 * largest;
    CHECK(zeros == 6);
    CHECK(eigen.eigenvalues()[6] > 1e-6 * largest);

    const Mat3 R = Eigen::AngleAxisd(1.1, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();
    const ElementNodes u = one.X * R.transpose() - one.X;
    SolidElement turned;
    solid(formulation, one.material, one.geometry, one.a, u, nullptr, true, turned);
    CHECK(turned.W < 1e-13);
    CHECK(turned.f.lpNorm<Eigen::Infinity>() < 1e-11 * largest);
    // the tangent turns with the body: same eigenvalues
    const Eigen::SelfAdjointEigenSolver<Mat24> after(turned.K);
    CHECK((after.eigenvalues() - eigen.eigenvalues()).lpNorm<Eigen::Infinity>() < 1e-9 * largest);
  }
}

TEST_CASE("a constant deformation gradient is reproduced on a distorted mesh: the patch test") {
  Mesh mesh = test::cube(3);
  test::distort(mesh, 0.08);
  Mat3 H;
  H << 0.2, 0.1, -0.05, 0.03, -0.1, 0.07, -0.02, 0.04, 0.05;
  const Material material = test::stable(40, 1e-2);
  for (Formulation formulation : formulations) {
    Equilibrium body(mesh, {material}, formulation, number_dofs(mesh.n_nodes(), {}).dofs);
    VecX u(3 * mesh.n_nodes());
    for (int i = 0; i < mesh.n_nodes(); ++i) u.segment<3>(3 * i) = H * mesh.X[i];
    REQUIRE(body.assemble(u, false));
    // inner nodes are in balance, and the stress is the one of F everywhere
    std::vector<char> outer(mesh.n_nodes(), 0);
    for (const auto& [name, nodes] : mesh.node_sets)
      for (int i : nodes) outer[i] = 1;
    for (int i = 0; i < mesh.n_nodes(); ++i)
      if (!outer[i]) CHECK(body.f_int().segment<3>(3 * i).norm() < 1e-13 * body.f_int().norm());
    const Mat3 F = Mat3::Identity() + H;
    const Mat3 sigma = cauchy(F, response(material, F.transpose() * F, fibre_directions(material)).S);
    for (int e = 0; e < mesh.n_cells(); ++e)
      for (const GaussState& g :
           gauss_states(formulation, material, body.geometry(e), body.fibres(e), body.element_displacements(u, e)))
        CHECK((g.sigma - sigma).norm() < 1e-11 * sigma.norm());
  }
}

TEST_CASE("an element turned inside out is refused") {
  const One one = distorted(1e-2);
  ElementNodes u = ElementNodes::Zero();
  u.row(0) = Eigen::RowVector3d(3, 3, 3);
  SolidElement out;
  for (Formulation formulation : formulations)
    CHECK_FALSE(solid(formulation, one.material, one.geometry, one.a, u, nullptr, true, out));
}
