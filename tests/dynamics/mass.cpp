// The mass matrix: kinetic energies of motions whose integrals are known, and its rows in the
// tangent's pattern.
#include "mechanics/assembly/mass.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/tensor/dense.hpp"
#include "mechanics/dynamics/inertia.hpp"
#include "mechanics/mesh/cut.hpp"
#include "mechanics/mesh/section.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

constexpr double rho = 1.1e-9;

Mesh box(CellType type) {
  Mesh mesh = test::block({0, 0.4, 2}, {0, 1, 3}, {0, 0.7, 1.5});
  if (type == CellType::hex8) return mesh;
  return test::raised_block(mesh, type);
}

Assembler body_of(const Mesh& mesh, Dofs dofs) {
  const std::vector<Material> materials(mesh.bodies.size(), test::table1(60, 1e-3));
  return test::equilibrium(mesh, materials, usual_formulation(mesh.type), std::move(dofs));
}

// v' M v of v(X) at the nodes that have unknowns
template <class Field>
double twice_kinetic_energy(const Mesh& mesh, const Dofs& dofs, const Mass& mass,
                            const Field& field) {
  VecX v = VecX::Zero(dofs.n);
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    if (dofs.node(i) == i && !hanging_at(mesh.hanging, i)) v.segment<3>(3 * i) = field(mesh.X[i]);
  }
  return v.dot(mass.M * v);
}

}  // namespace

TEST_CASE("a box has the mass and the moments of inertia of its density, of all cells") {
  const double m = rho * 2 * 3 * 1.5;
  for (CellType type : {CellType::hex8, CellType::hex27, CellType::tet15}) {
    const Mesh mesh = box(type);
    const Dofs dofs = number_dofs(mesh.n_nodes(), {}).dofs;
    const Assembler body = body_of(mesh, dofs);
    const Mass mass = make_mass(body.model(), {rho}, MassKind::consistent);
    CHECK(mass.total == near(m, 1e-13));
    const auto twice = [&](const auto& field) {
      return twice_kinetic_energy(mesh, dofs, mass, field);
    };
    CHECK(twice([](const Vec3&) { return Vec3(0, 7, 0); }) == near(49 * m, 1e-13));
    const Vec3 spin(0.2, -0.5, 0.3);
    const Vec3 middle(1, 1.5, 0.75);
    const double inertia = m / 12 *
                           (spin[0] * spin[0] * (9 + 2.25) + spin[1] * spin[1] * (4 + 2.25) +
                            spin[2] * spin[2] * (4 + 9));
    CHECK(twice([&](const Vec3& X) { return Vec3(spin.cross(X - middle)); }) ==
          near(inertia, 1e-12));
  }
}

TEST_CASE("a box that flies and turns has the momentum m v and the angular momentum of its spin") {
  const double m = rho * 2 * 3 * 1.5;
  const Vec3 middle(1, 1.5, 0.75);
  const Vec3 velocity(30, -20, 5);
  const Vec3 spin(0.2, -0.5, 0.3);
  const Vec3 inertia = m / 12 * Vec3(9 + 2.25, 4 + 2.25, 4 + 9);
  const Vec3 angular = m * middle.cross(velocity) + inertia.cwiseProduct(spin);
  for (CellType type : {CellType::hex8, CellType::hex27, CellType::tet15}) {
    const Mesh mesh = box(type);
    const Assembler body = body_of(mesh, number_dofs(mesh.n_nodes(), {}).dofs);
    const VecX u = VecX::Zero(3 * mesh.n_nodes());
    InertiaOptions all;
    all.density = {rho};
    all.velocity = velocity;
    all.spin = spin;
    all.spin_centre = middle;
    const Inertia whole(body, all);
    MotionState motion = whole.at_start();
    CHECK(whole.momentum(motion).isApprox(m * velocity, 1e-12));
    CHECK(whole.angular_momentum(u, motion).isApprox(angular, 1e-12));
    const double energy = 0.5 * (m * velocity.squaredNorm() + spin.dot(inertia.cwiseProduct(spin)));
    CHECK(motion.kinetic == near(energy, 1e-12));

    // The same as a body that moves on its own.
    MovingBody moving{"box", std::vector<int>(static_cast<std::size_t>(mesh.n_nodes()))};
    std::iota(moving.nodes.begin(), moving.nodes.end(), 0);
    moving.velocity = velocity;
    moving.spin = spin;
    moving.spin_centre = middle;
    InertiaOptions own;
    own.density = {rho};
    own.bodies = {moving};
    const Inertia one(body, own);
    CHECK(one.at_start().v.isApprox(motion.v, 1e-14));
    CHECK(one.momentum(motion, moving).isApprox(m * velocity, 1e-12));
    CHECK(one.mass_of(moving) == near(m, 1e-12));
  }
}

TEST_CASE("no movement of a cell is without mass") {
  for (const ReferenceCell& cell : reference_cells()) {
    ElementNodes X(cell.n_nodes, 3);
    for (int a = 0; a < cell.n_nodes; ++a) X.row(a) = cell.node[a].transpose();
    const MatX m = cell_mass(cell, X);
    const SymmetricEigen eigen = symmetric_eigen(m);
    CHECK(eigen.values.minCoeff() > 1e-3 * m.trace() / cell.n_nodes);
  }
}

TEST_CASE("a lumped mass is a diagonal with the sum of the consistent one, and only of hex8") {
  const Mesh mesh = box(CellType::hex8);
  const Dofs dofs = number_dofs(mesh.n_nodes(), {}).dofs;
  const Assembler body = body_of(mesh, dofs);
  const Mass lumped = make_mass(body.model(), {rho}, MassKind::lumped);
  const Mass consistent = make_mass(body.model(), {rho}, MassKind::consistent);
  CHECK(lumped.M.nonZeros() == dofs.n);
  const VecX ones = VecX::Ones(dofs.n);
  CHECK((lumped.M.diagonal() - consistent.M * ones).norm() < 1e-14 * lumped.M.diagonal().norm());
  const Mesh quadratic = box(CellType::hex27);
  const Assembler other = body_of(quadratic, number_dofs(quadratic.n_nodes(), {}).dofs);
  CHECK_THROWS_AS(make_mass(other.model(), {rho}, MassKind::lumped), std::invalid_argument);
}

TEST_CASE("bodies have densities of their own") {
  Mesh mesh = box(CellType::hex8);
  mesh.bodies = {"skin", "fat"};
  double expected = 0;
  const std::vector<double> densities = {1e-9, 3e-9};
  for (int e = 0; e < mesh.n_cells(); ++e) {
    mesh.body[e] = e % 2;
    expected += densities[e % 2] * element_geometry(element_nodes(mesh, e)).V;
  }
  const Assembler body = body_of(mesh, number_dofs(mesh.n_nodes(), {}).dofs);
  CHECK(make_mass(body.model(), densities, MassKind::consistent).total == near(expected, 1e-13));
}

TEST_CASE("a section weighs what its whole circle does, and widens with its kinetic energy") {
  constexpr double pi = std::numbers::pi;
  for (CellType type : {CellType::hex8, CellType::hex27}) {
    Mesh mesh = test::block({0, 0.5, 2}, {0, 1, 1.5}, {0, 1});
    mesh.node_sets.clear();
    if (type == CellType::hex27) {
      const Mesh linear = mesh;
      mesh = raised(linear, type);
      mesh.bodies = linear.bodies;
      mesh.body = linear.body;
      mesh.frames = linear.frames;
    }
    make_section(mesh, {SectionOf::axisymmetric, 0.2});
    const Dofs dofs = number_dofs(mesh.n_nodes(), {}, section_ties(mesh)).dofs;
    const std::vector<Material> materials = {test::table1(60, 1e-3)};
    const std::vector<double> shares(static_cast<std::size_t>(mesh.n_cells()),
                                     cell_share(*mesh.section));
    const Assembler body(mesh, materials, test::directions(mesh, materials),
                         usual_formulation(type), dofs, 1, Kernel::packets, shares);
    const Mass mass = make_mass(body.model(), {rho}, MassKind::consistent);
    CHECK(mass.total == near(rho * pi * 4 * 1.5, 1e-13));
    const double widening =
        twice_kinetic_energy(mesh, dofs, mass, [](const Vec3& X) { return Vec3(X[0], 0, 0); });
    CHECK(widening == near(rho * pi * 16 / 2 * 1.5, 1e-12));
    const double falling =
        twice_kinetic_energy(mesh, dofs, mass, [](const Vec3&) { return Vec3(0, 3, 0); });
    CHECK(falling == near(9 * mass.total, 1e-12));

    // What a whole circle has of momentum is along its axis.
    InertiaOptions options;
    options.density = {rho};
    options.velocity = Vec3(0, 3, 0);
    const Inertia inertia(body, options);
    MotionState motion = inertia.at_start();
    for (int i = 0; i < mesh.n_nodes(); ++i) {
      if (dofs.node(i) == i) motion.v[3 * i] = mesh.X[static_cast<std::size_t>(i)][0];
    }
    const Vec3 momentum = inertia.momentum(motion);
    CHECK(momentum[0] == 0);
    CHECK(momentum[1] == near(3 * mass.total, 1e-12));
    CHECK(momentum[2] == 0);
    CHECK(inertia.angular_momentum(VecX::Zero(dofs.n), motion).isZero(0));
  }
}

TEST_CASE("the mass in the tangent's pattern is that of the free rows, past hanging nodes") {
  Mesh cube = test::cube(2);
  cube.node_sets.clear();
  CutMesh cut(cube);
  std::vector<char> marked(static_cast<std::size_t>(cube.n_cells()), 0);
  marked[3] = 1;
  cut.cut(marked);
  const Mesh& mesh = cut.mesh();
  REQUIRE(!mesh.hanging.empty());
  std::vector<Prescribed> held;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    if (mesh.X[i][1] == 0) held.push_back({3 * i + 1, 0});
  }
  const Dofs dofs = number_dofs(mesh.n_nodes(), held, {}, mesh.hanging).dofs;
  const Assembler body = body_of(mesh, dofs);
  const Mass mass = make_mass(body.model(), {rho}, MassKind::consistent);
  CHECK(mass.total == near(rho, 1e-13));
  const auto drift =
      twice_kinetic_energy(mesh, dofs, mass, [](const Vec3& X) { return Vec3(1, X[0], 0); });
  CHECK(drift == near(rho * (1 + 1. / 3), 1e-12));  // past hanging nodes as well

  const std::vector<double> values = mass.in_pattern(body.pattern(), dofs);
  double largest = 0;
  for (int column = 0; column < body.pattern().n; ++column) {
    for (int k = body.pattern().column_start[column]; k < body.pattern().column_start[column + 1];
         ++k) {
      const int row = body.pattern().row[k];
      const double entry = mass.M.coeff(dofs.free[row], dofs.free[column]);
      largest = std::max(largest, std::abs(entry - values[k]));
    }
  }
  CHECK(largest == 0);
  CHECK(*std::max_element(values.begin(), values.end()) > 0);
}

TEST_CASE("mass-free nodes leave the mass, its centre and its moments as they were") {
  for (CellType type : {CellType::hex8, CellType::hex27, CellType::tet15}) {
    Mesh mesh = test::block(test::even(0, 2, 3), test::even(0, 3, 4), test::even(0, 1.5, 3));
    if (type != CellType::hex8) mesh = test::raised_block(mesh, type);
    const Dofs dofs = number_dofs(mesh.n_nodes(), {}).dofs;
    const Assembler body = body_of(mesh, dofs);
    std::vector<char> massless(static_cast<std::size_t>(mesh.n_nodes()), 0);
    for (int node : mesh.node_sets.at("y_max")) massless[node] = 1;
    const Mass all = make_mass(body.model(), {rho}, MassKind::consistent);
    const Mass some = make_mass(body.model(), {rho}, MassKind::consistent, massless);
    for (int node : mesh.node_sets.at("y_max")) {
      CHECK(some.M.col(3 * node + 1).norm() == 0);
    }
    CHECK(some.total == near(all.total, 1e-12));
    for (int k = 0; k < 4; ++k) {
      const auto field = [k](const Vec3& X) {
        const Vec3 spin(0.3, 1, -0.4);
        if (k == 0) return Vec3(spin.cross(X));
        return Vec3(X[k - 1] * spin + Vec3(0, 2, 0));
      };
      CHECK(twice_kinetic_energy(mesh, dofs, some, field) ==
            near(twice_kinetic_energy(mesh, dofs, all, field), 1e-12));
    }
    // nothing moves without a kinetic energy but the nodes without mass
    std::vector<int> kept;
    for (int i = 0; i < mesh.n_nodes(); ++i) {
      if (!massless[i]) kept.push_back(i);
    }
    const auto n = static_cast<Eigen::Index>(kept.size());
    MatX m(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) m(i, j) = some.M.coeff(3 * kept[i], 3 * kept[j]);
    }
    const SymmetricEigen eigen = symmetric_eigen(m);
    CHECK(eigen.values.minCoeff() > 1e-4 * m.trace() / static_cast<double>(n));
  }
}
