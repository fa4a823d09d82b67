// Cells with viscous branches: eight at once as one at a time, the tangent as the derivative of the
// force, the state of the points.
#include <doctest/doctest.h>

#include <Eigen/LU>
#include <random>

#include "core/tensor/kinematics.hpp"
#include "mechanics/element/packet_solid.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

struct CellKind {
  int n;
  Formulation formulation;
};
constexpr CellKind viscous_cells[] = {
    {8, Formulation::mean_dilatation},    {8, Formulation::displacement},
    {27, Formulation::linear_dilatation}, {27, Formulation::displacement},
    {15, Formulation::linear_dilatation}, {15, Formulation::displacement}};

std::vector<Material> materials() {
  Material all = test::stable(40, 1e-3), apart = test::table1(30, 1e-2),
           isotropic = test::neo_hooke(0.4, 1e-3);
  all.viscous = {{0.3, 0.5, BranchOf::all}, {10, 0.2, BranchOf::all}};
  apart.viscous = {
      {0.1, 0.6, BranchOf::matrix}, {2, 0.4, BranchOf::fibres}, {50, 0.1, BranchOf::all}};
  isotropic.spectrum = Spectrum{0.2, 0.1, 100};
  return {all, apart, isotropic};
}

struct Draw {
  std::mt19937 random{21};
  ElementNodes nodes(int n, double spread) {
    ElementNodes X(n, 3);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < 3; ++k)
        X(i, k) = 0.5 * reference(n).node[i][k] + spread * in(-0.15, 0.15);
    return X;
  }
  ElementNodes moves(int n, double spread) {
    ElementNodes u(n, 3);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < 3; ++k) u(i, k) = spread * in(-0.1, 0.1);
    return u;
  }
  double in(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
};

double spread_of(int n) { return n == 8 ? 1 : n == 27 ? 0.4 : 0.06; }

// points of one cell that has been through two increments, at the begin of a third
ViscousPoints led(const Material& m, const ElementGeometry& geometry, std::span<const Vec3> a,
                  Draw& draw, double seconds) {
  ViscousPoints points({m}, {}, 1, geometry.n_gauss());
  const int n = geometry.n_nodes();
  ElementNodes before = ElementNodes::Zero(n, 3);
  for (double step : {0.2, 1.5}) {
    const ElementNodes u = draw.moves(n, spread_of(n));
    points.begin(step);
    points.end(0, m, geometry, a, u);
    points.accept(0, geometry, before, u);
    points.accepted();
    before = u;
  }
  points.begin(seconds);
  return points;
}

}  // namespace

TEST_CASE("viscous cells: packets reproduce the scalar element, force and tangent") {
  Draw draw;
  for (const Material& material : materials()) {
    const auto a = fibre_directions(material);
    for (const CellKind& kind : viscous_cells) {
      const int n = kind.n;
      const Formulation formulation = kind.formulation;
      const int n_p = n_pressures(formulation, n);
      std::vector<ElementGeometry> geometry;
      std::vector<ElementNodes> u;
      std::vector<CellMemory> memory;
      const double seconds = draw.in(0.01, 5);
      for (int l = 0; l < 8; ++l) {
        geometry.push_back(element_geometry(draw.nodes(n, spread_of(n))));
        u.push_back(draw.moves(n, spread_of(n)));
        memory.push_back(led(material, geometry[l], a, draw, seconds).memory(0));
      }
      const ElementGeometry* pointers[8];
      std::vector<Packet> moved(3 * n), H(6 * geometry[0].n_gauss());
      PacketFibre fibre[1];
      for (int l = 0; l < 8; ++l) {
        pointers[l] = &geometry[l];
        for (int i = 0; i < 3 * n; ++i) moved[i].set(l, u[l](i / 3, i % 3));
        for (int k = 0; k < 3 && !a.empty(); ++k) fibre[0].a[k].set(l, a[0][k]);
        for (int g = 0; g < geometry[0].n_gauss(); ++g)
          for (int p = 0; p < 6; ++p) H[6 * g + p].set(l, memory[l].H[g][p]);
      }
      const PacketMemory together{memory[0].amplified, H.data()};
      PacketElement out(n, n_p);
      const double local = test::local_modulus(formulation, material);
      packet_solid(formulation, material, local, packed(pointers), fibre, moved.data(), nullptr,
                   true, out, &together);
      for (int l = 0; l < 8; ++l) {
        SolidElement one, elastic;
        REQUIRE(solid(formulation, material, local, geometry[l], a, u[l], nullptr, true, one,
                      &memory[l]));
        REQUIRE(solid(formulation, material, local, geometry[l], a, u[l], nullptr, true, elastic));
        CHECK(out.W[l] == near(elastic.W, 1e-12));
        CHECK((one.f - elastic.f).norm() > 1e-6 * elastic.f.norm());
        double worst_f = 0, worst_K = 0;
        for (int i = 0; i < 3 * n; ++i) {
          worst_f = std::max(worst_f, std::abs(out.f[i][l] - one.f[i]));
          for (int j = 0; j <= i; ++j)
            worst_K = std::max(worst_K, std::abs(out.K[i * (i + 1) / 2 + j][l] - one.K(i, j)));
        }
        CHECK(worst_f <= 1e-12 * one.f.lpNorm<Eigen::Infinity>());
        CHECK(worst_K <= 1e-12 * one.K.lpNorm<Eigen::Infinity>());
      }
    }
  }
}

TEST_CASE("viscous cells: the tangent is the derivative of the force") {
  Draw draw;
  for (const Material& material : materials()) {
    const auto a = fibre_directions(material);
    for (const CellKind& kind : viscous_cells) {
      const int n = kind.n;
      const Formulation formulation = kind.formulation;
      const ElementGeometry geometry = element_geometry(draw.nodes(n, spread_of(n)));
      const CellMemory memory = led(material, geometry, a, draw, draw.in(0.01, 5)).memory(0);
      const ElementNodes u = draw.moves(n, spread_of(n)), way = draw.moves(n, spread_of(n));
      const auto force = [&](double step) {
        SolidElement out;
        REQUIRE(solid(formulation, material, 0, geometry, a, u + step * way, nullptr, false, out,
                      &memory));
        return out.f;
      };
      SolidElement at;
      REQUIRE(solid(formulation, material, 0, geometry, a, u, nullptr, true, at, &memory));
      VecX d(3 * n);
      for (int i = 0; i < 3 * n; ++i) d[i] = way(i / 3, i % 3);
      const double h = 1e-3;
      const VecX differences =
                     (8 * (force(h) - force(-h)) - (force(2 * h) - force(-2 * h))) / (12 * h),
                 exact = at.K * d;
      CAPTURE(n);
      CHECK((differences - exact).norm() <= 1e-7 * exact.norm());
      CHECK((at.K - at.K.transpose()).norm() <= 1e-12 * at.K.norm());
    }
  }
}

TEST_CASE(
    "viscous cells: work against the branches is that of the stress at the points, never negative in small cycles") {
  Draw draw;
  for (const Material& material : materials()) {
    const auto a = fibre_directions(material);
    const ElementGeometry geometry = element_geometry(draw.nodes(8, 1));
    ViscousPoints points({material}, {}, 1, geometry.n_gauss());
    ElementNodes before = ElementNodes::Zero(8, 3);
    const ElementNodes way = draw.moves(8, 1e-2);
    double external = 0, stored = 0;
    for (int i = 1; i <= 400; ++i) {
      const ElementNodes u = std::sin(0.03 * i) * way;
      points.begin(0.01);
      const CellMemory memory = points.memory(0);
      // mean of the forces at both ends, each with its own branch stresses
      const auto force = [&](const ElementNodes& q) {
        VecX f = VecX::Zero(24);
        const auto states =
            gauss_states(Formulation::displacement, material, geometry, a, q, points.stresses(0));
        for (int g = 0; g < geometry.n_gauss(); ++g) {
          const Mat3 P = states[g].J * states[g].sigma * states[g].F.transpose().inverse();
          const Eigen::Matrix<double, 8, 3> force =
              geometry.w[g] * geometry.dN_dX[g] * P.transpose();
          for (int k = 0; k < 24; ++k) f[k] += force(k / 3, k % 3);
        }
        return f;
      };
      const VecX f0 = force(before);
      points.end(0, material, geometry, a, u);
      points.accept(0, geometry, before, u);
      points.accepted();
      const VecX f1 = force(u);
      for (int k = 0; k < 24; ++k)
        external += 0.5 * (f0[k] + f1[k]) * (u(k / 3, k % 3) - before(k / 3, k % 3));
      before = u;
      double work = 0;
      for (int g = 0; g < geometry.n_gauss(); ++g) {
        work += geometry.w[g] * points.work(0, g);
        CHECK(points.work(0, g) >= -1e-12);
      }
      SolidElement out;
      REQUIRE(solid(Formulation::displacement, material, 0, geometry, a, u, nullptr, false, out));
      stored = out.W;
      if (i == 400) CHECK(external - stored == near(work, 1e-3));
    }
  }
}

TEST_CASE("viscous cells: the time error weighs each branch with the stress of its own terms") {
  Draw draw;
  const Material material = materials()[1];  // branches of the matrix, of the fibres and of both
  const auto a = fibre_directions(material);
  const std::vector<ViscousBranch> branches = branches_of(material);
  const ElementGeometry geometry = element_geometry(draw.nodes(8, 1));
  const ElementNodes far = draw.moves(8, 1);

  const auto stress = [&](const ElementNodes& u, int g, BranchOf of) -> Vec6 {
    const Mat3 F = deformation_gradient(displacement_gradient(u, geometry.dN_dX[g]));
    return isochoric(material, right_cauchy_green(F), a, only(of), false).S;
  };
  const auto size = [&](const ElementNodes& u) {
    double sum = 0;
    for (int g = 0; g < geometry.n_gauss(); ++g) {
      double here = 0;
      for (const BranchOf of : {BranchOf::matrix, BranchOf::fibres, BranchOf::all}) {
        here += stress(u, g, of).norm();
      }
      sum += geometry.w[g] * here * here;
    }
    return sum;
  };

  ViscousPoints points({material}, {}, 1, geometry.n_gauss());
  ElementNodes before = ElementNodes::Zero(8, 3);
  double largest = 0;
  // back towards rest: the stresses that errors are compared with stay those of the farthest place
  for (const double share : {1.0, 0.3, 0.2}) {
    const double seconds = 0.5 + share;
    const ElementNodes u = share * far;
    points.begin(seconds);
    points.end(0, material, geometry, a, u);
    double square = 0;
    for (int g = 0; g < geometry.n_gauss(); ++g) {
      double here = 0;
      for (const ViscousBranch& branch : branches) {
        const Vec6 change = stress(u, g, branch.of) - stress(before, g, branch.of);
        here += branch_step_error(branch, seconds) * change.norm();
      }
      square += geometry.w[g] * here * here;
    }
    largest = std::max(largest, size(u));
    CHECK(points.error() == near(std::sqrt(square / largest), 1e-12));
    points.accept(0, geometry, before, u);
    points.accepted();
    before = u;
  }
  CHECK(largest == near(size(far)));
}
