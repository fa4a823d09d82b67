// Element tests: patch, rigid motion, tangent, all formulations.
#include "mechanics/element/solid.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "core/tensor/dense.hpp"
#include "core/tensor/stress.hpp"
#include "mechanics/assembly/assembler.hpp"
#include "mechanics/element/packet_solid.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

struct One {
  ElementNodes X;
  ElementGeometry geometry;
  std::vector<Vec3> a;
  Material material;
};

// a cell type by its number of nodes, and how the dilatation enters
struct Kind {
  int n;
  Formulation formulation;
};
const Kind kinds[] = {{8, Formulation::mean_dilatation},    {8, Formulation::displacement},
                      {27, Formulation::linear_dilatation}, {27, Formulation::mean_dilatation},
                      {27, Formulation::displacement},      {15, Formulation::linear_dilatation},
                      {15, Formulation::displacement}};

One distorted(int n_nodes, double d, unsigned seed = 5) {
  One one;
  const auto& node = reference(n_nodes).node;
  std::mt19937 random(seed);
  const double most = n_nodes == 8 ? 0.15 : n_nodes == 27 ? 0.06 : 0.01;
  std::uniform_real_distribution<double> u(-most, most);
  one.X.resize(n_nodes, 3);
  for (int n = 0; n < n_nodes; ++n)
    for (int k = 0; k < 3; ++k) one.X(n, k) = 0.5 * node[n][k] + u(random);
  one.geometry = element_geometry(one.X);
  one.material = test::stable(30, d);
  one.a = fibre_directions(one.material);
  return one;
}

ElementNodes some_displacement(int n_nodes, unsigned seed) {
  ElementNodes u(n_nodes, 3);
  std::mt19937 random(seed);
  const double size = n_nodes == 8 ? 0.1 : n_nodes == 27 ? 0.04 : 0.006;
  std::uniform_real_distribution<double> r(-size, size);
  for (auto& v : u.reshaped()) v = r(random);
  return u;
}

}  // namespace

TEST_CASE("the internal force is the gradient of the stored energy") {
  for (const auto& [n, formulation] : kinds) {
    const One one = distorted(n, 1e-2);
    const ElementNodes u = some_displacement(n, 1);
    SolidElement at, plus, minus;
    REQUIRE(solid(formulation, one.material, test::local_modulus(formulation, one.material),
                  one.geometry, one.a, u, nullptr, false, at));
    const double h = 1e-6, scale = at.f.lpNorm<Eigen::Infinity>();
    for (int i = 0; i < 3 * n; ++i) {
      ElementNodes up = u, down = u;
      up(i / 3, i % 3) += h, down(i / 3, i % 3) -= h;
      solid(formulation, one.material, test::local_modulus(formulation, one.material), one.geometry,
            one.a, up, nullptr, false, plus);
      solid(formulation, one.material, test::local_modulus(formulation, one.material), one.geometry,
            one.a, down, nullptr, false, minus);
      CHECK(std::abs((plus.W - minus.W) / (2 * h) - at.f[i]) <= 1e-7 * scale);
    }
  }
}

TEST_CASE("the tangent is the derivative of the force, and symmetric") {
  for (double d : {1.0, 1e-2, 1e-4}) {
    for (const auto& [n, formulation] : kinds) {
      const One one = distorted(n, d);
      const ElementNodes u = some_displacement(n, 2);
      SolidElement at, plus, minus;
      REQUIRE(solid(formulation, one.material, test::local_modulus(formulation, one.material),
                    one.geometry, one.a, u, nullptr, true, at));
      const double scale = at.K.lpNorm<Eigen::Infinity>(), h = 3e-6;
      CHECK((at.K - at.K.transpose()).lpNorm<Eigen::Infinity>() <= 1e-13 * scale);
      for (int j = 0; j < 3 * n; ++j) {
        ElementNodes up = u, down = u;
        up(j / 3, j % 3) += h, down(j / 3, j % 3) -= h;
        solid(formulation, one.material, test::local_modulus(formulation, one.material),
              one.geometry, one.a, up, nullptr, false, plus);
        solid(formulation, one.material, test::local_modulus(formulation, one.material),
              one.geometry, one.a, down, nullptr, false, minus);
        CHECK(((plus.f - minus.f) / (2 * h) - at.K.col(j)).lpNorm<Eigen::Infinity>() <=
              1e-7 * scale);
      }
    }
  }
}

TEST_CASE(
    "whatever resists the volume: the force is the gradient of the energy, the tangent the symmetric derivative of the force") {
  for (const Volume& volume : {Volume(LogarithmicVolume{300}), Volume(SimoTaylorVolume{300})})
    for (const auto& [n, formulation] : kinds) {
      One one = distorted(n, 1e-2);
      one.material.volume = volume, one.material.fibres[0].law = ExpPowFibre{0.1, 0.3, 2.5};
      const double local = test::local_modulus(formulation, one.material);
      const ElementNodes u = some_displacement(n, 7);
      SolidElement at, plus, minus;
      REQUIRE(solid(formulation, one.material, local, one.geometry, one.a, u, nullptr, true, at));
      const double force = at.f.lpNorm<Eigen::Infinity>(), scale = at.K.lpNorm<Eigen::Infinity>(),
                   h = 3e-6;
      CHECK((at.K - at.K.transpose()).lpNorm<Eigen::Infinity>() <= 1e-13 * scale);
      for (int j = 0; j < 3 * n; j += n == 8 ? 1 : 5) {
        ElementNodes up = u, down = u;
        up(j / 3, j % 3) += h, down(j / 3, j % 3) -= h;
        solid(formulation, one.material, local, one.geometry, one.a, up, nullptr, false, plus);
        solid(formulation, one.material, local, one.geometry, one.a, down, nullptr, false, minus);
        CHECK(std::abs((plus.W - minus.W) / (2 * h) - at.f[j]) <= 1e-7 * force);
        CHECK(((plus.f - minus.f) / (2 * h) - at.K.col(j)).lpNorm<Eigen::Infinity>() <=
              1e-7 * scale);
      }
      // the mean stress of its points is the volume's pressure, since the rest is isochoric
      for (const GaussState& s : gauss_states(formulation, one.material, one.geometry, one.a, u))
        CHECK(s.sigma.trace() / 3 == near(s.pressure, 1e-9, 1e-12 * s.sigma.norm()));
    }
}

TEST_CASE("the dilatation's gradient is its derivative") {
  for (const auto& [n, formulation] : kinds) {
    const One one = distorted(n, 1e-2);
    const ElementNodes u = some_displacement(n, 3);
    SolidElement at, plus, minus;
    solid(formulation, one.material, test::local_modulus(formulation, one.material), one.geometry,
          one.a, u, nullptr, false, at);
    const double h = 1e-6;
    for (int j = 0; j < 3 * n; ++j) {
      ElementNodes up = u, down = u;
      up(j / 3, j % 3) += h, down(j / 3, j % 3) -= h;
      solid(formulation, one.material, test::local_modulus(formulation, one.material), one.geometry,
            one.a, up, nullptr, false, plus);
      solid(formulation, one.material, test::local_modulus(formulation, one.material), one.geometry,
            one.a, down, nullptr, false, minus);
      // some derivatives are 0; rounding leaves eps/h = 2e-10 of them
      for (int k = 0; k < n_pressures(formulation, n); ++k)
        CHECK((plus.J_minus_1[k] - minus.J_minus_1[k]) / (2 * h) ==
              near(at.dJ_du[k][j], 1e-7, 1e-9));
    }
  }
}

TEST_CASE("a rigid rotation costs nothing and K has six zero eigenvalues, no more") {
  for (const auto& [n, formulation] : kinds) {
    const One one = distorted(n, 1e-2);
    SolidElement rest;
    solid(formulation, one.material, test::local_modulus(formulation, one.material), one.geometry,
          one.a, ElementNodes::Zero(n, 3), nullptr, true, rest);
    const VecX eigen = symmetric_eigenvalues(rest.K);
    const double largest = eigen[3 * n - 1];
    int zeros = 0;
    for (double value : eigen) zeros += std::abs(value) < 1e-12 * largest;
    CHECK(zeros == 6);
    CHECK(eigen[6] > 1e-6 * largest);

    const Mat3 R = Eigen::AngleAxisd(1.1, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();
    const ElementNodes u = one.X * R.transpose() - one.X;
    SolidElement turned;
    solid(formulation, one.material, test::local_modulus(formulation, one.material), one.geometry,
          one.a, u, nullptr, true, turned);
    CHECK(turned.W < 1e-13);
    CHECK(turned.f.lpNorm<Eigen::Infinity>() < 1e-11 * largest);
    // the tangent turns with the body: same eigenvalues
    CHECK((symmetric_eigenvalues(turned.K) - eigen).lpNorm<Eigen::Infinity>() < 1e-9 * largest);
  }
}

TEST_CASE("a constant deformation gradient is reproduced on a distorted mesh: the patch test") {
  Mat3 H;
  H << 0.2, 0.1, -0.05, 0.03, -0.1, 0.07, -0.02, 0.04, 0.05;
  const Material material = test::stable(40, 1e-2);
  for (const auto& [n, formulation] : kinds) {
    // hex27: corners are moved before the other nodes are put between them, and then these too:
    // curved edges and faces
    Mesh mesh = test::cube(3);
    test::distort(mesh, 0.08);
    if (n == 27) mesh = test::raised_block(mesh), test::distort(mesh, 0.02, 4);
    if (n == 15)
      mesh = test::raised_block(
          mesh, CellType::tet15);  // straight edges: curved ones are beyond its Gauss points
    Assembler body =
        test::equilibrium(mesh, {material}, formulation, number_dofs(mesh.n_nodes(), {}).dofs);
    VecX u(3 * mesh.n_nodes());
    for (int i = 0; i < mesh.n_nodes(); ++i) u.segment<3>(3 * i) = H * mesh.X[i];
    REQUIRE(body.assemble(u, false));
    // inner nodes are in balance, and the stress is the one of F everywhere
    std::vector<char> outer(mesh.n_nodes(), 0);
    for (const auto& [name, nodes] : mesh.node_sets)
      for (int i : nodes) outer[i] = 1;
    int inner = 0;
    for (int i = 0; i < mesh.n_nodes(); ++i)
      if (!outer[i]) {
        ++inner;
        CHECK(body.f_int().segment<3>(3 * i).norm() < 1e-13 * body.f_int().norm());
      }
    CHECK(inner == (n == 8    ? 8
                    : n == 27 ? 125
                              : 8 + 117 + 270 +
                                    162));  // tetrahedra: corners, middles of edges, facets, cells
    const Mat3 F = Mat3::Identity() + H;
    const Mat3 sigma =
        cauchy(F, response(material, F.transpose() * F, fibre_directions(material)).S);
    for (int e = 0; e < mesh.n_cells(); ++e)
      for (const GaussState& g : gauss_states(formulation, material, body.geometry(e),
                                              body.fibres(e), body.element_displacements(u, e)))
        CHECK((g.sigma - sigma).norm() < 1e-11 * sigma.norm());
  }
}

TEST_CASE("stresses of eight points at once are those of each point") {
  for (const auto& [n, formulation] : kinds) {
    const One one = distorted(n, 1e-2);
    const ElementNodes u = some_displacement(n, 5);
    Material without_packets = one.material;
    without_packets.matrix = {MooneyRivlin{0.1, 0.05}};
    CHECK(packet_form(one.material));
    CHECK_FALSE(packet_form(without_packets));
    for (const Material& material : {one.material, without_packets}) {
      for (const GaussState& s : gauss_states(formulation, material, one.geometry, one.a, u)) {
        const Vec6 S = isochoric(material, s.F.transpose() * s.F, one.a, false).S;
        const Mat3 expected = s.F * tensor(S) * s.F.transpose() / s.J;
        CHECK((s.sigma - s.pressure * Mat3::Identity() - expected).norm() <=
              1e-12 * s.sigma.norm());
      }
    }
  }
}

TEST_CASE("an element turned inside out is refused") {
  for (const auto& [n, formulation] : kinds) {
    const One one = distorted(n, 1e-2);
    ElementNodes u = ElementNodes::Zero(n, 3);
    u.row(0) = Eigen::RowVector3d(3, 3, 3);
    SolidElement out;
    CHECK_FALSE(solid(formulation, one.material, test::local_modulus(formulation, one.material),
                      one.geometry, one.a, u, nullptr, true, out));
  }
}

TEST_CASE("modes of the dilatation: orthonormal, and linear in X, in cells of any shape") {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (const auto& [n, aspect] : {std::pair{27, 1.0}, {27, 1e3}, {27, 1e6}, {15, 1.0}, {15, 1e3}}) {
    ElementNodes X = distorted(n, 1e-2).X;
    X.col(1) /= aspect;
    X = (X * turn).rowwise() + Eigen::RowVector3d(100, -50, 30);
    const ElementGeometry geometry = element_geometry(X);
    const ReferenceCell& cell = reference(n);
    Eigen::Matrix4d product = Eigen::Matrix4d::Zero();
    MatX mode(cell.n_gauss, 4), linear(cell.n_gauss, 4);
    for (int g = 0; g < cell.n_gauss; ++g) {
      mode.row(g) = Eigen::Map<const Eigen::RowVector4d>(geometry.mode[g].data());
      const Vec3 x = turn * (X.transpose() * cell.N[g] - Vec3(100, -50, 30));
      linear.row(g) << 1, x[0], x[1] * aspect, x[2];
      product += geometry.w[g] / geometry.V * mode.row(g).transpose() * mode.row(g);
    }
    CHECK((product - Eigen::Matrix4d::Identity()).norm() < 1e-13);
    const MatX by = PivotedQr(linear).solve_columns(mode);
    CHECK((linear * by - mode).norm() <
          1e-13 * 200 * aspect);  // rounding of X, seen across the thin side
  }
}

TEST_CASE("the mean of I4_bar over the points of a cell is that of its stretched fibres") {
  const Vec3 a = Vec3(1, 2, 0).normalized();
  std::vector<GaussState> states(2);
  states[0].F = Vec3(1.2, 0.9, 1).asDiagonal();
  states[0].J = states[0].F.determinant();
  states[1].F = Vec3(0.8, 1.1, 1.3).asDiagonal();
  states[1].J = states[1].F.determinant();
  const auto I4_bar = [](double x, double y, double J) {
    return (0.2 * x * x + 0.8 * y * y) / std::pow(J, 2.0 / 3);
  };
  const double first = I4_bar(1.2, 0.9, 1.2 * 0.9);
  const double second = I4_bar(0.8, 1.1, 0.8 * 1.1 * 1.3);
  CHECK(mean_I4_bar(states, a) == near(0.5 * (first + second), 1e-14));
}
