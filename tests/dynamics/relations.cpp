// Relations that motions have whatever their scene: reversed in time they go back, and in a frame
// that moves at constant velocity they are the same.
#include <doctest/doctest.h>

#include <cmath>

#include "dynamics/moving.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

InertiaOptions without_loss(Scheme scheme) {
  InertiaOptions options;
  options.scheme = scheme;
  options.rho_inf = 1;
  options.density = {1e-9};
  options.spin = Vec3(700, -300, 500);
  return options;
}

// From here on with all velocities turned round.
void reverse(test::Moving& moving) {
  BodyState state = moving.increment().accepted();
  state.motion.v = -state.motion.v;
  state.t = 0;
  moving.restart_from(state);
}

}  // namespace

TEST_CASE("an elastic body that is reversed in time goes back to where it began") {
  const Mesh mesh = test::block({0, 1, 2}, {0, 1}, {0, 1.3});
  const int n = 40;
  for (Scheme scheme : {Scheme::generalised_alpha, Scheme::energy_momentum, Scheme::theta}) {
    test::Moving block(mesh, test::neo_hooke(0.05, 2), number_dofs(mesh.n_nodes(), {}).dofs,
                       without_loss(scheme), {}, 1e-5, n);
    for (int i = 0; i < n; ++i) block.step(1e-12);
    const double farthest = block.increment().accepted().u.norm();
    reverse(block);
    for (int i = 0; i < n; ++i) block.step(1e-12);
    CHECK(block.increment().accepted().u.norm() < 1e-8 * farthest);
    CHECK(farthest > 0.5);
  }
}

TEST_CASE("an elastic bounce without friction, reversed in time, ends where it began") {
  const Mesh mesh = test::block({0, 1}, test::even(0, 3, 6), {0, 1});
  InertiaOptions options = without_loss(Scheme::generalised_alpha);
  options.spin = Vec3::Zero();
  options.velocity = Vec3(0, -100, 0);
  options.massless = {1};
  RigidContact wall;
  wall.name = "wall";
  wall.shape = Plane{{0, -0.02, 0}, {0, 1, 0}};
  wall.nodes = mesh.node_sets.at("y_min");
  wall.motion = {{1, Vec3::Zero()}};
  const int n = 200;
  test::Moving block(mesh, test::neo_hooke(0.15, 4), number_dofs(mesh.n_nodes(), {}).dofs, options,
                     {wall}, 1e-3 / n, n);
  double most = 0;
  for (int i = 0; i < n; ++i) {
    block.step(1e-12);
    most = std::max(most, block.force());
  }
  REQUIRE(most > 0);
  REQUIRE(block.force() == 0);
  CHECK(block.increment().accepted().u[1] > 0.03);
  reverse(block);
  for (int i = 0; i < n; ++i) block.step(1e-12);
  CHECK(block.increment().accepted().u.lpNorm<Eigen::Infinity>() < 1e-10);
}

TEST_CASE("a body moves alike in a frame that moves at constant velocity") {
  const Mesh mesh = test::block({0, 1, 2}, {0, 1}, {0, 1.3});
  const Vec3 shift(300, -50, 80);
  const int n = 30;
  for (Scheme scheme : {Scheme::generalised_alpha, Scheme::energy_momentum, Scheme::theta}) {
    const auto end_of = [&](const Vec3& velocity) {
      InertiaOptions options = without_loss(scheme);
      options.velocity = velocity;
      test::Moving block(mesh, test::neo_hooke(0.05, 2), number_dofs(mesh.n_nodes(), {}).dofs,
                         options, {}, 1e-5, n);
      for (int i = 0; i < n; ++i) block.step();
      return block.increment().accepted().u;
    };
    VecX moving = end_of(shift);
    const VecX still = end_of(Vec3::Zero());
    for (Eigen::Index i = 0; i < moving.size(); i += 3) moving.segment<3>(i) -= n * 1e-5 * shift;
    CHECK((moving - still).lpNorm<Eigen::Infinity>() < 1e-9 * still.lpNorm<Eigen::Infinity>());
  }
}
