// Motion without contact: tangents, orders of convergence, conservation.
#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "dynamics/moving.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

Dofs clamped(const Mesh& mesh, const char* set) {
  std::vector<Prescribed> held;
  for (int node : mesh.node_sets.at(set)) {
    for (int k = 0; k < 3; ++k) held.push_back({3 * node + k, 0});
  }
  return number_dofs(mesh.n_nodes(), held).dofs;
}

InertiaOptions of_scheme(Scheme scheme) {
  InertiaOptions options;
  options.scheme = scheme;
  options.density = {1e-9};
  return options;
}

// With Rayleigh damping, both parts of which matter.
InertiaOptions damped(InertiaOptions options) {
  options.damping_mass = 2000;
  options.damping_stiffness = 2e-6;
  return options;
}

// Where the end of a cantilever is that begins to move across.
Vec3 end_of_beam(InertiaOptions options, int n_steps) {
  const Mesh mesh = test::block(test::even(0, 4, 4), {0, 1}, {0, 1});
  options.velocity = Vec3(0, 2000, 300);
  test::Moving beam(mesh, test::neo_hooke(0.1, 1), clamped(mesh, "x_min"), options, {},
                    2e-4 / n_steps, n_steps);
  for (int i = 0; i < n_steps; ++i) beam.step();
  return beam.increment().accepted().u.segment<3>(3 * mesh.node_sets.at("x_max").front());
}

double order_of(const InertiaOptions& options) {
  const Vec3 coarse = end_of_beam(options, 40);
  const Vec3 middle = end_of_beam(options, 80);
  const Vec3 fine = end_of_beam(options, 160);
  return std::log2((coarse - middle).norm() / (middle - fine).norm());
}

}  // namespace

TEST_CASE("the tangent of a body in motion is the derivative of its balance") {
  Mesh mesh = test::cube(2);
  test::distort(mesh, 0.05);
  const Dofs dofs = clamped(mesh, "y_min");
  for (Scheme scheme : {Scheme::generalised_alpha, Scheme::energy_momentum, Scheme::theta}) {
    InertiaOptions options = of_scheme(scheme);
    options.damping_mass = 300;
    options.damping_stiffness = 1e-4;
    options.velocity = Vec3(10, -300, 40);
    options.gravity = Vec3(0, -9810, 0);
    test::Moving moving(mesh, test::neo_hooke(0.1, 0.5), dofs, options, {}, 1e-4, 4, {},
                        Formulation::displacement);
    moving.step();
    moving.increment().begin(0.5);
    Assembler& body = moving.body();
    VecX u = moving.increment().trial();
    for (int dof : dofs.free) u[dof] += 0.01 * std::sin(3.0 * dof);
    VecX direction(dofs.n_free());
    VecX all = VecX::Zero(dofs.n);
    for (int row = 0; row < dofs.n_free(); ++row) {
      direction[row] = std::cos(2.0 * row);
      all[dofs.free[row]] = direction[row];
    }
    body.pressures_from(u);
    REQUIRE(body.assemble(u, true));
    VecX product = body.K_times(direction);
    if (body.conserves()) {
      const VecX skew = body.conserving_skew(all);
      for (int row = 0; row < dofs.n_free(); ++row) product[row] += skew[dofs.free[row]];
    }
    const double h = 1e-5;
    REQUIRE(body.assemble(u + h * all, false));
    const VecX after = body.f_int();
    REQUIRE(body.assemble(u - h * all, false));
    const VecX change = (after - body.f_int()) / (2 * h);
    VecX difference(dofs.n_free());
    for (int row = 0; row < dofs.n_free(); ++row) {
      difference[row] = change[dofs.free[row]] - product[row];
    }
    CHECK(difference.norm() < 1e-7 * product.norm());
  }
}

TEST_CASE(
    "generalised alpha and energy momentum are of second order, theta above a half of first") {
  CHECK(order_of(of_scheme(Scheme::generalised_alpha)) == near(2, 0.1));
  CHECK(order_of(of_scheme(Scheme::energy_momentum)) == near(2, 0.1));
  InertiaOptions theta = of_scheme(Scheme::theta);
  theta.theta = 0.6;
  theta.xi = 0.6;
  CHECK(order_of(theta) == near(1, 0.2));
  theta.theta = 0.5;
  theta.xi = 0.5;
  CHECK(order_of(theta) == near(2, 0.1));
}

TEST_CASE("Rayleigh damping leaves each scheme its order") {
  CHECK(order_of(damped(of_scheme(Scheme::generalised_alpha))) == near(2, 0.1));
  CHECK(order_of(damped(of_scheme(Scheme::energy_momentum))) == near(2, 0.1));
  CHECK(order_of(damped(of_scheme(Scheme::theta))) == near(2, 0.1));
}

// The speed of its base is that at which the body begins to move.
TEST_CASE("a body whose base is moved at its own speed is not strained") {
  const Mesh mesh = test::cube(2);
  const Vec3 velocity(120, -40, 300);
  const double step = 1e-4;
  const int n_steps = 8;
  std::vector<Prescribed> held;
  for (int node : mesh.node_sets.at("y_min")) {
    for (int k = 0; k < 3; ++k) held.push_back({3 * node + k, velocity[k] * step * n_steps});
  }
  const Dofs dofs = number_dofs(mesh.n_nodes(), held).dofs;
  for (Scheme scheme : {Scheme::generalised_alpha, Scheme::theta}) {
    InertiaOptions options = of_scheme(scheme);
    options.velocity = velocity;
    test::Moving moving(mesh, test::neo_hooke(0.1, 0.5), dofs, options, {}, step, n_steps);
    for (int i = 1; i <= n_steps; ++i) {
      moving.step();
      const VecX& u = moving.increment().accepted().u;
      for (int node = 0; node < mesh.n_nodes(); ++node) {
        const Vec3 off = u.segment<3>(3 * node) - i * step * velocity;
        CHECK(off.norm() < 1e-9 * i * step * velocity.norm());
      }
    }
    CHECK(moving.motion().stored < 1e-12 * moving.motion().kinetic);
  }
}

TEST_CASE("a body falls by g t^2 / 2, whatever the scheme") {
  const Mesh mesh = test::cube(1);
  for (Scheme scheme : {Scheme::generalised_alpha, Scheme::energy_momentum, Scheme::theta}) {
    InertiaOptions options = of_scheme(scheme);
    options.gravity = Vec3(0, -9810, 0);
    options.velocity = Vec3(100, 0, 0);
    test::Moving block(mesh, test::neo_hooke(0.1, 0.5), number_dofs(mesh.n_nodes(), {}).dofs,
                       options, {}, 1e-3, 10);
    for (int i = 0; i < 10; ++i) block.step();
    const VecX& u = block.increment().accepted().u;
    CHECK(u[0] == near(1, 1e-9));
    CHECK(u[1] == near(-0.5 * 9810 * 1e-4, 1e-9));
    CHECK(std::abs(block.motion().balance) < 1e-9 * block.energy());
  }
}

namespace {

// Free rows of the stiffness at rest, or of the mass.
struct LinearBody {
  MatX K, M;
};

LinearBody linear(const Mesh& mesh, const Material& material, const Dofs& dofs, double density) {
  const std::vector<Material> materials(mesh.bodies.size(), material);
  Assembler body(mesh, materials, test::directions(mesh, materials), Formulation::mean_dilatation,
                 dofs, 1, Kernel::packets);
  const VecX rest = VecX::Zero(dofs.n);
  body.pressures_from(rest);
  REQUIRE(body.assemble(rest, true));
  const MatX all = make_mass(body.model(), {density}, MassKind::consistent, {}).M;
  const int n = dofs.n_free();
  LinearBody out{MatX(n, n), MatX(n, n)};
  for (int j = 0; j < n; ++j) {
    out.K.col(j) = body.K_times(VecX::Unit(n, j));
    for (int i = 0; i < n; ++i) out.M(i, j) = all(dofs.free[i], dofs.free[j]);
  }
  return out;
}

}  // namespace

// In each mode q'' + (c_m + c_k w^2) q' + w^2 q = 0.
TEST_CASE("a small vibration under Rayleigh damping decays as its modes do") {
  const Mesh mesh = test::cube(1);
  const Material material = test::neo_hooke(0.1, 0.5);
  const Dofs dofs = clamped(mesh, "y_min");
  const LinearBody body = linear(mesh, material, dofs, 1e-9);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatX> modes(body.K, body.M);
  const Vec3 velocity(1, 0.3, -0.4);  // mm/s
  VecX start(dofs.n_free());
  for (int row = 0; row < dofs.n_free(); ++row) start[row] = velocity[dofs.free[row] % 3];
  const double time = 3e-4;
  const int n_steps = 1200;
  struct Case {
    Scheme scheme;
    double mass, stiffness;
  };
  for (const Case& damping :
       {Case{Scheme::generalised_alpha, 2000, 0}, Case{Scheme::generalised_alpha, 0, 2e-6},
        Case{Scheme::generalised_alpha, 2000, 2e-6}, Case{Scheme::energy_momentum, 2000, 2e-6},
        Case{Scheme::theta, 2000, 2e-6}}) {
    CAPTURE(damping.mass);
    CAPTURE(damping.stiffness);
    InertiaOptions options = of_scheme(damping.scheme);
    options.velocity = velocity;
    options.damping_mass = damping.mass;
    options.damping_stiffness = damping.stiffness;
    test::Moving moving(mesh, material, dofs, options, {}, time / n_steps, n_steps);
    const double kinetic = moving.motion().kinetic;
    for (int i = 0; i < n_steps; ++i) moving.step();

    VecX exact = VecX::Zero(dofs.n_free());
    for (int k = 0; k < dofs.n_free(); ++k) {
      const double squared = modes.eigenvalues()[k];
      const double decay = 0.5 * (damping.mass + damping.stiffness * squared);
      const double damped = std::sqrt(squared - decay * decay);
      const VecX mode = modes.eigenvectors().col(k);
      const double speed = mode.dot(body.M * start);
      exact += mode * speed / damped * std::exp(-decay * time) * std::sin(damped * time);
    }
    VecX found(dofs.n_free());
    for (int row = 0; row < dofs.n_free(); ++row) {
      found[row] = moving.increment().accepted().u[dofs.free[row]];
    }
    CHECK((found - exact).norm() < 1e-3 * exact.norm());
    CHECK(moving.energy() < 0.9 * kinetic);
    CHECK(std::abs(moving.motion().balance) < 1e-5 * kinetic);
  }
}
