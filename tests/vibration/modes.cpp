// Natural frequencies against closed forms.
#include "mechanics/vibration/modes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "core/tensor/dense.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/vibration/eigenpairs.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"
#include "vibration/soft_body.hpp"

using namespace langer;

namespace {

using test::a1;
using test::pi;
using test::rho;

double frequency_of(double wave_number, double modulus) {
  return std::sqrt(modulus / rho) * wave_number / (2 * pi);
}

// The frequencies of a body in the state u of its unknowns, other bodies standing still.
Modes modes_at(const Mesh& mesh, const Material& material, const std::vector<Prescribed>& held,
               const VecX& u, int count) {
  Assembler body = test::equilibrium(mesh, {material}, usual_formulation(mesh.type),
                                     number_dofs(mesh.n_nodes(), held).dofs);
  Increment increment(body, {}, {});
  BodyState state = increment.accepted();
  state.u = u;
  increment.restore(state);
  return modes_of(body, increment, {rho}, {}, count);
}

VecX at_rest(const Mesh& mesh) { return VecX::Zero(3 * mesh.n_nodes()); }

// A column along y that shears along x only: all of y and z is held, and x at its foot.
std::vector<Prescribed> shear_only(const Mesh& mesh) {
  std::vector<Prescribed> held;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    held.push_back({3 * i + 1, 0});
    held.push_back({3 * i + 2, 0});
  }
  for (int i : mesh.node_sets.at("y_min")) held.push_back({3 * i, 0});
  return held;
}

Mesh column(CellType type, int cells, double height) {
  const Mesh linear = test::block({0, 1}, test::even(0, height, cells), {0, 1});
  if (type == CellType::hex8) return linear;
  return test::raised_block(linear, type);
}

// An eighth of a ball of radius 1 from four blocks of n x n x n cells whose outer nodes are on the
// sphere: a cube in the middle, and one on each of its outer faces.
Mesh eighth_of_a_ball(int n) {
  constexpr double inner = 0.5;
  Mesh mesh;
  mesh.type = CellType::hex27;
  std::map<std::array<long, 3>, int> known;
  const auto node_at = [&](const Vec3& x) {
    std::array<long, 3> key{};
    for (int k = 0; k < 3; ++k) key[static_cast<std::size_t>(k)] = std::lround(1e7 * x[k]);
    const auto [at, is_new] = known.try_emplace(key, mesh.n_nodes());
    if (is_new) mesh.X.push_back(x);
    return at->second;
  };
  for (int block = 0; block < 4; ++block) {
    const int outward = block - 1;
    const auto place = [&](Vec3 s) -> Vec3 {
      if (block == 0) return inner * s;
      const double r = s[outward];
      s[outward] = 1;
      return (1 - r) * inner * s + r * s.normalized();
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        for (int k = 0; k < n; ++k) {
          for (const auto& xi : Hex27::node) {
            const Vec3 s(i + 0.5 * (1 + xi[0]), j + 0.5 * (1 + xi[1]), k + 0.5 * (1 + xi[2]));
            mesh.connectivity.push_back(node_at(place(s / n)));
          }
        }
      }
    }
  }
  mesh.bodies = {"ball"};
  mesh.body.assign(static_cast<std::size_t>(mesh.n_cells()), 0);
  mesh.frames.assign(mesh.body.size(), Mat3::Identity());
  return mesh;
}

}  // namespace

TEST_CASE("eigenvalues that are many times there are all found and counted") {
  constexpr int n = 60;
  SparseX K(n, n);
  SparseX M(n, n);
  for (int i = 0; i < n; ++i) {
    K.insert(i, i) = 2 * (i < 9 ? 3.0 : 1.0 + i);
    M.insert(i, i) = 2;
  }
  const Eigenpairs found = lowest_eigenpairs(K, M, 11);
  CHECK(found.counted);
  REQUIRE(found.values.size() == 11);
  for (int i = 0; i < 9; ++i) CHECK(found.values[i] == near(3, 1e-9));
  CHECK(found.values[9] == near(10, 1e-9));
  CHECK(found.values[10] == near(11, 1e-9));
}

TEST_CASE("eigenpairs of a full matrix satisfy its equation, negative ones among them") {
  constexpr int n = 40;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> some(-1, 1);
  MatX A(n, n);
  MatX B(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      A(i, j) = some(random);
      B(i, j) = some(random);
    }
  }
  const MatX K = A + A.transpose();
  const MatX M = B * B.transpose() + MatX::Identity(n, n);
  const Eigenpairs found = lowest_eigenpairs(K.sparseView(), M.sparseView(), 6);
  REQUIRE(found.values.size() == 6);
  CHECK(found.values[0] < 0);
  for (int i = 0; i < 6; ++i) {
    const VecX x = found.vectors.col(i);
    CHECK(x.dot(M * x) == near(1, 1e-10));
    CHECK((K * x - found.values[i] * (M * x)).norm() < 1e-7 * (K * x).norm());
  }
  // all others are above
  const MatX half = M.llt().matrixL().solve(K);
  const VecX all = symmetric_eigenvalues(M.llt().matrixL().solve(half.transpose()));
  for (int i = 0; i < 6; ++i) CHECK(found.values[i] == near(all[i], 1e-8, 1e-9));
}

TEST_CASE("a clamped column shears at odd quarters of its wave length") {
  const double height = 3;
  const Mesh mesh = column(CellType::hex27, 16, height);
  const Modes found = modes_at(mesh, test::neo_hooke(a1, 1e-3), shear_only(mesh), at_rest(mesh), 3);
  CHECK(found.counted);
  for (int n = 1; n <= 3; ++n) {
    const double k = (2 * n - 1) * pi / (2 * height);
    CHECK(found.modes[static_cast<std::size_t>(n - 1)].frequency() ==
          near(frequency_of(k, 2 * a1), 1e-4));
  }
}

TEST_CASE("modes of a viscous body are those after its branches have relaxed") {
  const Mesh mesh = column(CellType::hex8, 4, 3);
  Material viscous = test::neo_hooke(a1, 1e-3);
  viscous.viscous = {ViscousBranch{0.1, 0.7}};
  const auto lowest = [&](const Material& material) {
    return modes_at(mesh, material, shear_only(mesh), at_rest(mesh), 1).modes[0].frequency();
  };
  CHECK(lowest(viscous) == near(lowest(test::neo_hooke(a1, 1e-3)), 1e-12));
}

TEST_CASE("frequencies of hex8 converge with the square of the cells from above") {
  const double exact = frequency_of(pi / 6, 2 * a1);
  std::vector<double> error;
  for (int cells : {8, 16}) {
    const Mesh mesh = column(CellType::hex8, cells, 3);
    const Modes found =
        modes_at(mesh, test::neo_hooke(a1, 1e-3), shear_only(mesh), at_rest(mesh), 1);
    error.push_back(found.modes[0].frequency() / exact - 1);
  }
  CHECK(error[1] > 0);
  CHECK(std::log2(error[0] / error[1]) == near(2, 0.02));
}

// rho c^2 = 2 a1 lambda^2 along the stretched axis: the wave length is stretched as well, so the
// frequency of a column of given cells stays.
TEST_CASE("shear waves run along a stretched neo-Hookean column at sqrt(2 a1 / rho) lambda") {
  const double lambda = 1.5;
  const Mesh mesh = column(CellType::hex27, 8, 3);
  VecX u = at_rest(mesh);
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const Vec3 X = mesh.X[i];
    const double across = 1 / std::sqrt(lambda);
    u.segment<3>(3 * i) = Vec3((across - 1) * X[0], (lambda - 1) * X[1], (across - 1) * X[2]);
  }
  const Modes found = modes_at(mesh, test::neo_hooke(a1, 1e-4), shear_only(mesh), u, 1);
  const double speed = std::sqrt(2 * a1 / rho) * lambda;
  const double wave_length = 4 * 3 * lambda;
  CHECK(found.modes[0].frequency() == near(speed / wave_length, 1e-3));
  CHECK(found.modes[0].growth() == 0);
}

TEST_CASE("the lowest torsional frequency of a ball is 2.5011 of its shear wave's") {
  const Mesh mesh = eighth_of_a_ball(2);
  std::vector<Prescribed> held;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    for (int plane = 0; plane < 3; ++plane) {
      if (std::abs(mesh.X[i][plane]) > 1e-9) continue;
      for (int k = 0; k < 3; ++k) {
        if (k != plane) held.push_back({3 * i + k, 0});
      }
    }
  }
  const Modes found = modes_at(mesh, test::neo_hooke(a1, 1e-4), held, at_rest(mesh), 3);
  CHECK(found.counted);
  const double exact = frequency_of(2.50113, 2 * a1);
  // two of the five movements of this kind are antisymmetric to all three planes
  CHECK(found.modes[0].frequency() == near(exact, 1e-3));
  CHECK(found.modes[1].frequency() == near(exact, 1e-3));
  CHECK(found.modes[2].frequency() > 1.2 * exact);
}

TEST_CASE("a free body has six movements without a frequency") {
  const Mesh mesh = test::raised_block(test::cube(2), CellType::tet15);
  const Modes found = modes_at(mesh, test::neo_hooke(a1, 1e-3), {}, at_rest(mesh), 8);
  const double first = found.modes[6].frequency();
  for (std::size_t i = 0; i < 6; ++i) CHECK(found.modes[i].frequency() < 1e-3 * first);
  CHECK(first > 0.1 * frequency_of(pi, 2 * a1));
}
