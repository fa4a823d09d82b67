// What an increment may be given and what it refuses: dead loads in proportion to t, elements that
// are turned inside out.
#include "mechanics/solve/increment.hpp"

#include <doctest/doctest.h>

#include "mechanics/element/surface.hpp"
#include "mechanics/mesh/select.hpp"
#include "mechanics/nonlinear/newton.hpp"
#include "scene/model/scene.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"

using namespace langer;

namespace {

struct Held {
  Mesh mesh = test::cube(2);
  Assembler body;
  Increment increment;
  Held()
      : body(test::equilibrium(mesh, {test::stable(35, 1)}, Formulation::mean_dilatation,
                               held_below(mesh))),
        increment(body, {}, {}) {}
  static Dofs held_below(const Mesh& mesh) {
    std::vector<Prescribed> held;
    for (int n : mesh.node_sets.at("y_min"))
      for (int k = 0; k < 3; ++k) held.push_back({3 * n + k, 0});
    return number_dofs(mesh.n_nodes(), held).dofs;
  }
};

}  // namespace

TEST_CASE("a dead load grows in proportion to t: supports bear t times it") {
  Held held;
  const Vec3 load(0.004, 0.01, -0.002);  // [N]
  Mesh sided = held.mesh;
  name_sides(sided);
  const auto& top = sided.facet_sets.at("y_max");
  held.body.set_loads({held.mesh, {{top, load / nodal_areas(held.mesh, top).sum()}}});
  for (double t : {0.25, 0.5, 1.0}) {
    held.increment.begin(t);
    REQUIRE(newton(held.increment.problem(), held.increment.trial(), {}).converged());
    held.increment.accept();
    const VecX reactions = held.increment.reactions();
    Vec3 sum = Vec3::Zero();
    for (int n : held.mesh.node_sets.at("y_min")) sum += reactions.segment<3>(3 * n);
    CHECK((sum + t * load).norm() <= 1e-6 * load.norm());
  }
}

TEST_CASE(
    "a step that turns an element inside out, or nearly so, is not admissible; one that halves its volume is") {
  Held held;
  held.increment.begin(0.5);
  const Problem problem = held.increment.problem();
  const auto by = [&](double share) {  // the upper cells, by this share of their height
    VecX u = VecX::Zero(3 * held.mesh.n_nodes());
    const auto& top = held.mesh.node_sets.at("y_max");
    const double cell =
        0.5 * (held.mesh.X[top[0]][1] - held.mesh.X[held.mesh.node_sets.at("y_min")[0]][1]);
    for (int n : top) u[3 * n + 1] = -share * cell;
    return u;
  };
  CHECK(problem.admissible(by(0)));
  CHECK(problem.admissible(by(0.5)));
  CHECK(!problem.admissible(by(0.99)));
  CHECK(!problem.admissible(by(1.5)));
  VecX nan = by(0);
  nan[4] = std::numeric_limits<double>::quiet_NaN();
  CHECK(!problem.admissible(nan));
}

TEST_CASE(
    "a state whose forces lie outside Coulomb's cone is no answer, by however little and though nothing slips") {
  Held held;
  const double mu = 0.4;
  const auto& top = held.mesh.node_sets.at("y_max");
  const Vec3 on_top = held.mesh.X[static_cast<std::size_t>(top[0])];
  const RigidContact rough{
      "rough", Plane{{on_top[0], on_top[1], on_top[2]}, {0, -1, 0}}, mu, top, {{1, Vec3(0, 0, 0)}}};
  Increment increment(held.body, {rough}, {});
  // at rest the plane just touches: with these forces gap, slip and their work are 0
  const auto assessed = [&](double share, double r_n) {
    BodyState state = increment.accepted();
    for (Vec3& r : state.r[0]) r = r_n * Vec3(share * mu, -1, 0);
    increment.restore(state);
    increment.begin(0.5);
    return increment.problem().assess(increment.trial(), false);
  };
  for (double share : {0.0, 0.5, 1 - 1e-7, 1.0}) CHECK(assessed(share, 0.01).others);
  for (double share : {1 + 1e-7, 1 + 1e-4, 1.5}) {
    CAPTURE(share);
    CHECK(assessed(share, 0.01).missing == "the contact law does not hold");
  }
  CHECK(!assessed(0, -0.01).others);  // a pull
}
