// Bodies that nothing holds: energy and angular momentum of a tumbling block.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "dynamics/moving.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// A block that flies, turns about an axis that is none of its own, and rings: its spin does not
// bear its stretch. Wave speed 1e4 mm/s, edges of 1 to 2 mm.
InertiaOptions tumbling(const Mesh& mesh, Scheme scheme) {
  InertiaOptions options;
  options.scheme = scheme;
  options.density = {1e-9};
  options.velocity = Vec3(300, 100, 0);
  options.spin = Vec3(900, 500, -1400);
  options.spin_centre = Vec3::Zero();
  for (const Vec3& X : mesh.X) options.spin_centre += X / mesh.n_nodes();
  return options;
}

Mesh brick(int n) {
  return test::block(test::even(0, 2, n), test::even(0, 1, n), test::even(0, 1.4, n));
}

struct Kept {
  double energy = 0, angular = 0, momentum = 0;  // largest relative change
  double strained = 0;                           // largest share of the energy that is stored
};

Kept fly(const Mesh& mesh, const Material& material, int steps, double step,
         Formulation formulation = Formulation::mean_dilatation) {
  const InertiaOptions options = tumbling(mesh, Scheme::energy_momentum);
  test::Moving block(mesh, material, number_dofs(mesh.n_nodes(), {}).dofs, options, {}, step, steps,
                     {}, formulation);
  const auto angular = [&] {
    const BodyState& now = block.increment().accepted();
    return block.inertia().angular_momentum(now.u, now.motion);
  };
  const double energy = block.energy();
  const Vec3 momentum = block.inertia().momentum(block.motion());
  const Vec3 spin = angular();
  Kept kept;
  for (int i = 0; i < steps; ++i) {
    block.step(1e-12);
    kept.energy = std::max(kept.energy, std::abs(block.energy() / energy - 1));
    kept.angular = std::max(kept.angular, (angular() - spin).norm() / spin.norm());
    kept.momentum =
        std::max(kept.momentum,
                 (block.inertia().momentum(block.motion()) - momentum).norm() / momentum.norm());
    kept.strained = std::max(kept.strained, block.motion().stored / energy);
  }
  return kept;
}

}  // namespace

TEST_CASE("a tumbling block keeps its energy, its momentum and its angular momentum") {
  const std::vector<std::pair<std::string, Material>> materials = {
      {"soft", test::neo_hooke(0.05, 2)},
      {"nearly incompressible", test::neo_hooke(0.05, 1e-3)},
      {"fibres", test::stable(30, 0.5)}};
  for (const auto& [name, material] : materials) {
    const auto shown = name;
    CAPTURE(shown);
    for (double step : {2e-5, 1e-4}) {
      const Kept kept = fly(brick(1), material, 150, step);
      CAPTURE(step);
      // Displacements are rounded to 1e-15 mm, and pressures to that times the bulk modulus.
      const double allowed = bulk_modulus(material) > 100 ? 2e-9 : 1e-12;
      CHECK(kept.energy < allowed);
      CHECK(kept.angular < allowed);
      CHECK(kept.momentum < allowed);
      CHECK(kept.strained > 1e-3);
    }
  }
  const Kept finer = fly(brick(2), materials[0].second, 40, 5e-5);
  CHECK(finer.energy < 1e-12);
  CHECK(finer.angular < 1e-12);
}

TEST_CASE("cells of second order and cells without mean dilatation keep angular momentum, too") {
  const Material material = test::neo_hooke(0.05, 2);
  const Kept plain = fly(brick(1), material, 60, 5e-5, Formulation::displacement);
  CHECK(plain.energy < 1e-12);
  CHECK(plain.angular < 1e-12);
  for (CellType type : {CellType::hex27, CellType::tet15}) {
    const Kept kept =
        fly(test::raised_block(brick(1), type), material, 15, 5e-5, Formulation::linear_dilatation);
    CHECK(kept.angular < 1e-10);
    CHECK(kept.momentum < 1e-10);
    // The bubble modulus follows the pressure of the cell, and has no energy of its own.
    CHECK(kept.energy < 1e-3);
  }
}

TEST_CASE("a tumbling block is where it should be to the second order of the step") {
  const Mesh mesh = brick(1);
  const auto end_of = [&](int steps) {
    test::Moving block(mesh, test::neo_hooke(0.05, 2), number_dofs(mesh.n_nodes(), {}).dofs,
                       tumbling(mesh, Scheme::energy_momentum), {}, 1e-4 / steps, steps);
    for (int i = 0; i < steps; ++i) block.step(1e-12);
    return block.increment().accepted().u;
  };
  const VecX coarse = end_of(40);
  const VecX middle = end_of(80);
  const VecX fine = end_of(160);
  CHECK(std::log2((coarse - middle).norm() / (middle - fine).norm()) == near(2, 0.05));
}

TEST_CASE("a rigid-like block turns about its longest axis for ever as Euler says") {
  // Spin about a principal axis: angle = spin * time, to the second order of the step.
  const Mesh mesh = brick(1);
  InertiaOptions options = tumbling(mesh, Scheme::energy_momentum);
  options.velocity = Vec3::Zero();
  options.spin = Vec3(0, 0, 100);
  const int steps = 60;
  test::Moving block(mesh, test::neo_hooke(500, 1e-3), number_dofs(mesh.n_nodes(), {}).dofs,
                     options, {}, 1e-4, steps);
  for (int i = 0; i < steps; ++i) block.step(1e-12);
  const VecX& u = block.increment().accepted().u;
  const double h = 1e-4 * 100;
  const double angle = steps * 2 * std::atan(h / 2);  // of the mid-point rule
  const Mat3 R = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const Vec3 X = mesh.X[i] - options.spin_centre;
    const Vec3 x = X + u.segment<3>(3 * i);
    CHECK((x - R * X).norm() < 1e-4);
  }
}
