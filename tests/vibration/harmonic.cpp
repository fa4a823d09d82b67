// Complex stiffness against closed forms and against differences of forces.
#include "mechanics/vibration/harmonic.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/mesh/section.hpp"
#include "mechanics/nonlinear/newton.hpp"
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
constexpr double shear = 2 * a1;

Material viscous(double d, double tau, double gamma) {
  Material m = test::neo_hooke(a1, d);
  m.viscous = {ViscousBranch{tau, gamma}};
  return m;
}

Complex shear_at(double frequency, double tau, double gamma) {
  const Complex x(0, 2 * pi * frequency * tau);
  return shear * (1.0 + gamma * x / (1.0 + x));
}

// A block under a frictionless or sticking sphere, followed by hand.
struct Pressed {
  Mesh mesh = test::block(test::graded(3, 6, 0.8), test::even(0, 3, 2), test::graded(3, 6, 0.8));
  Material material;
  double friction;
  double seconds;
  RigidContact ball{"ball", Sphere{3, {0.1, 6, -0.05}}, friction, {}, {}, {}};
  std::optional<Assembler> body;
  std::optional<Increment> increment;

  // depth at t = 0.9, and by `more` deeper at t = 0.9 + dt
  Pressed(const Material& law, double mu, double depth, double more, double dt, double duration)
      : material(law), friction(mu), seconds(duration) {
    std::vector<Prescribed> held;
    for (int i : mesh.node_sets.at("y_min")) {
      for (int k = 0; k < 3; ++k) held.push_back({3 * i + k, 0});
    }
    ball.motion = {{0.9, Vec3(0, -depth, 0)}, {0.9 + dt, Vec3(0, -depth - more, 0)}};
    for (int i : mesh.node_sets.at("y_max")) ball.nodes.push_back(i);
    const std::vector<Material> materials{material};
    body.emplace(mesh, materials, test::directions(mesh, materials), Formulation::mean_dilatation,
                 number_dofs(mesh.n_nodes(), held).dofs);
    IncrementOptions options;
    options.seconds = seconds;
    increment.emplace(*body, std::vector{ball}, options);
    for (double t : {0.225, 0.45, 0.675, 0.9}) step(t);
  }
  void step(double t) {
    increment->begin(t);
    NewtonOptions tight;
    tight.relative = 1e-12;
    REQUIRE(newton(increment->problem(), increment->trial(), tight).converged());
    if (body->viscous()) increment->time_error();
    increment->accept();
  }
  double force() const {  // on the indenter, against its movement
    double sum = 0;
    for (const Vec3& r : increment->accepted().r[0]) sum -= r[1];
    return sum;
  }
};

constexpr double little = 1e-5;  // mm
constexpr double soon = 1e-10;   // of t

// dF/ds of a short movement of the sphere
double difference(const Material& law, double mu, double seconds) {
  double force[2];
  for (int k = 0; k < 2; ++k) {
    Pressed scene(law, mu, 0.5, k == 0 ? -little : little, soon, seconds);
    scene.step(0.9 + soon);
    force[k] = scene.force();
  }
  return (force[1] - force[0]) / (2 * little);
}

// almost without inertia
Complex stiffness_of(const Material& law, double mu, double seconds, double frequency) {
  Pressed scene(law, mu, 0.5, 0, soon, seconds);
  Driver driver;
  driver.contact = 0;
  driver.along = -Vec3::UnitY();
  return Harmonic(*scene.body, *scene.increment, {1e-9 * rho}, driver).stiffness(frequency);
}

}  // namespace

TEST_CASE("at low frequency an indenter has the stiffness of its force over depth") {
  const Material law = test::stable(30, 1e-2);
  for (double mu : {0.0, 5.0}) {
    CAPTURE(mu);
    const Complex k = stiffness_of(law, mu, 0, 1e-3);
    CHECK(std::abs(difference(law, mu, 0)) == near(k.real(), 2e-6));
    CHECK(k.imag() == near(0, 0, 1e-12 * k.real()));
  }
}

TEST_CASE("at high frequency a pressed viscous body has the stiffness of a sudden movement") {
  Material law = test::stable(30, 1e-2);
  law.viscous = {ViscousBranch{1, 0.7}, ViscousBranch{3, 0.4, BranchOf::fibres}};
  const double seconds = 1e6;  // all has relaxed at t = 0.9
  const double sudden = std::abs(difference(law, 0, seconds));
  const Complex slow = stiffness_of(law, 0, seconds, 1e-6);
  const Complex fast = stiffness_of(law, 0, seconds, 1e3 / (2 * pi));
  CHECK(fast.real() > 1.5 * slow.real());
  // of branches, the largest part not answered at once: (1e-4 s / 1 s) / 2
  CHECK(sudden == near(fast.real(), 2e-4));
}

TEST_CASE("a sheared column has the stiffness of its waves, with damping and inertia") {
  const double height = 3;
  const double tau = 1e-3;
  const double gamma = 0.5;
  const Mesh mesh = test::raised_block(test::block({0, 1}, test::even(0, height, 12), {0, 2}));
  std::vector<Prescribed> held;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    held.push_back({3 * i + 1, 0});
    held.push_back({3 * i + 2, 0});
  }
  for (int i : mesh.node_sets.at("y_min")) held.push_back({3 * i, 0});
  for (int i : mesh.node_sets.at("y_max")) held.push_back({3 * i, 0.1});
  Assembler body =
      test::equilibrium(mesh, {viscous(1e-3, tau, gamma)}, Formulation::linear_dilatation,
                        number_dofs(mesh.n_nodes(), held).dofs);
  const Increment increment(body, {}, {});
  Driver driver;
  driver.nodes = mesh.node_sets.at("y_max");
  driver.along = Vec3::UnitX();
  Harmonic harmonic(body, increment, {rho}, driver);
  for (double frequency : {1.0, 100.0, 400.0, 1000.0}) {
    CAPTURE(frequency);
    const Complex G = shear_at(frequency, tau, gamma);
    const Complex k = 2 * pi * frequency * std::sqrt(rho / G);
    const double area = 2;
    const Complex exact = G * area * k / std::tan(k * height);
    const Complex found = harmonic.stiffness(frequency);
    CHECK(std::abs(found - exact) < 2e-4 * std::abs(exact));
  }
}

TEST_CASE("a bonded disc on a half space has the stiffness 8 G*(w) a") {
  // cells half as long from one to the next towards the rim, and towards the surface
  std::vector<double> r{0};
  std::vector<double> outside;
  std::vector<double> y;
  for (int k = 1; k <= 7; ++k) r.push_back(1 - std::ldexp(1.0, -k));
  for (int k = 7; k >= -8; --k) outside.push_back(1 + std::ldexp(1.0, -k));
  r.push_back(1);
  r.insert(r.end(), outside.begin(), outside.end());
  for (int k = -8; k <= 7; ++k) y.push_back(-std::ldexp(1.0, -k));
  y.push_back(0);
  Mesh mesh = test::raised_block(test::block(r, y, {0, 1}));
  mesh.node_sets.clear();
  make_section(mesh, {SectionOf::axisymmetric, 0x1p-14});
  std::vector<Prescribed> held;
  Driver driver;
  driver.along = -Vec3::UnitY();
  for (int i = 0; i < n_front(mesh); ++i) {
    if (mesh.X[i][1] == y.front()) {
      if (mesh.X[i][0] > 0) held.push_back({3 * i, 0});
      held.push_back({3 * i + 1, 0});
    }
    if (mesh.X[i][1] != 0 || mesh.X[i][0] > 1) continue;
    if (mesh.X[i][0] > 0) held.push_back({3 * i, 0});  // bonded
    driver.nodes.push_back(i);
  }
  const std::vector<Material> materials{viscous(1e-4, 1, 0.8)};
  Assembler body(
      mesh, materials, test::directions(mesh, materials), Formulation::linear_dilatation,
      number_dofs(mesh.n_nodes(), held, section_ties(mesh)).dofs, 1, Kernel::packets,
      std::vector<double>(static_cast<std::size_t>(mesh.n_cells()), cell_share(*mesh.section)));
  const Increment increment(body, {}, {});
  Harmonic harmonic(body, increment, {rho}, driver);
  for (double frequency : {0.016, 0.16, 1.6}) {
    CAPTURE(frequency);
    const Complex exact = 8.0 * shear_at(frequency, 1, 0.8);
    const Complex found = harmonic.stiffness(frequency);
    CHECK(found.real() == near(exact.real(), 1e-2));
    CHECK(found.imag() == near(exact.imag(), 1e-2));
  }
}
