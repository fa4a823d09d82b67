// Contact scenes with known answers: Hertz, a wedge under friction.
#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/nonlinear/load_path.hpp"
#include "mechanics/solve/increment.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// from -length to 0, finest at 0
std::vector<double> towards_zero(double length, int n, double h) {
  const auto both = test::graded(length, 2 * n, h);
  return {both.begin(), both.begin() + n + 1};
}

PathReport follow_path(Increment& increment, double length, const std::vector<double>& stops = {}) {
  LoadPathOptions path;
  path.first = path.largest = length;
  return load_path(
      path, 0, {}, stops,
      [&](double t) {
        increment.begin(t);
        return newton(increment.problem(), increment.trial(), {});
      },
      [&](double, double, double, const SolveReport&) {
        increment.accept();
        return true;
      });
}

}  // namespace

TEST_CASE(
    "Hertz: a sphere on an incompressible half-space, F = 16/9 E sqrt(R) delta^1.5 within 2 %") {
  // a quarter of a block 400 times as thick as the contact is wide; bottom fixed
  const double R = 25, depth = 0.0225, a1 = 0.3, E = 6 * a1;
  auto x = test::graded(150, 40, 0.08);
  x.erase(x.begin(), x.begin() + 20);
  const Mesh mesh = test::block(x, towards_zero(150, 18, 0.1), x);
  std::vector<Prescribed> held;
  for (int i : mesh.node_sets.at("y_min"))
    for (int k = 0; k < 3; ++k) held.push_back({3 * i + k, 0});
  for (int i : mesh.node_sets.at("x_min")) held.push_back({3 * i, 0});
  for (int i : mesh.node_sets.at("z_min")) held.push_back({3 * i + 2, 0});
  RigidContact sphere{"sphere", Sphere{R, {0, R, 0}}, 0, {}, {{1, Vec3(0, -depth, 0)}}};
  for (int i : mesh.node_sets.at("y_max"))
    if (std::hypot(mesh.X[i][0], mesh.X[i][2]) < 1.2) sphere.nodes.push_back(i);
  Assembler body =
      test::equilibrium(mesh, {test::neo_hooke(a1, 1e-4)}, Formulation::mean_dilatation,
                        number_dofs(mesh.n_nodes(), held).dofs);
  Increment increment(body, {sphere}, {});
  REQUIRE(follow_path(increment, 0.5).complete);
  const double force = -4 * increment.defects()[0].force[1],
               hertz = 16. / 9 * E * std::sqrt(R) * std::pow(depth, 1.5);
  MESSAGE("force " << force << " N, Hertz " << hertz << " N");
  CHECK(force == near(hertz, 0.02));
}

TEST_CASE("a wedge pushed under a block: F/G = (tan a + mu)/(1 - mu tan a)") {
  // plane strain; the block hangs on its top face, the wedge (slope 0.1) is pressed up and then
  // pushed under it
  for (const auto& [mu, ratio] :
       {std::pair{0.0, 0.1}, {0.1, 0.20202020}, {0.2, 0.30612245}, {0.3, 0.41237113}}) {
    Mesh mesh = test::block(test::even(0, 4, 4), test::even(0, 1, 2), {0, 0.5});
    for (Vec3& X : mesh.X)
      X[1] += 0.1 * X[0] * (1 - X[1]);  // the lower face has the slope of the wedge
    std::vector<Prescribed> held;
    for (int i = 0; i < mesh.n_nodes(); ++i) held.push_back({3 * i + 2, 0});
    for (int i : mesh.node_sets.at("y_max"))
      for (int k = 0; k < 2; ++k) held.push_back({3 * i + k, 0});
    const RigidContact wedge{"wedge",
                             Plane{{0, 0, 0}, {-0.1, 1, 0}},
                             mu,
                             mesh.node_sets.at("y_min"),
                             {{0.1, Vec3(0, 0.01, 0)}, {1, Vec3(-0.3, 0.01, 0)}}};
    Assembler body =
        test::equilibrium(mesh, {test::neo_hooke(1, 1e-2)}, Formulation::mean_dilatation,
                          number_dofs(mesh.n_nodes(), held).dofs);
    Increment increment(body, {wedge}, {});
    REQUIRE(follow_path(increment, 0.05, {0.1}).complete);
    const ContactDefect defect = increment.defects()[0];
    const double friction = mu;
    CAPTURE(friction);
    CHECK(defect.stick == 0);
    CHECK(defect.slip == 10);
    CHECK(std::abs(defect.force[0]) / defect.force[1] == near(ratio, 1e-6));
  }
}

TEST_CASE(
    "a weight on a slope sticks where the slope is less steep than friction, and slides where it is steeper") {
  const double G = 3, mu = 0.34;
  for (double slope : {0.0, 0.1, 0.33, 0.35, 0.8}) {
    const double c = 1 / std::hypot(1, slope), s = slope * c;
    const Vec3 weight(-G * c, G * s, 0);  // in the frame of the slope: into it, down along it
    LocalProblem p{0.01 * MatX::Identity(3, 3), 0.01 * weight, VecX::Constant(1, mu)};
    VecX r = VecX::Zero(3);
    const LocalReport report = solve_local(p, r);
    CAPTURE(slope);
    CHECK(report.converged);
    CHECK(r[0] == near(G * c, 1e-12));
    CHECK(report.status[0] == (slope < mu ? ContactStatus::stick : ContactStatus::slip));
    CHECK(r[1] == near(-std::min(G * s, mu * G * c), 1e-12));
  }
}
