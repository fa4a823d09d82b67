// Indenters of one scene do not know of each other.
#include <doctest/doctest.h>

#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

TEST_CASE(
    "an indenter with friction that stays away from the nodes of another changes nothing, in whatever order they come") {
  const Mesh mesh =
      test::block(test::graded(6, 8, 0.8), test::even(0, 3, 2), test::graded(6, 8, 0.8));
  Scene scene;
  scene.formulation = usual_formulation(mesh.type);
  scene.materials = {test::stable(30, 1e-2)};
  scene.directions = test::directions(mesh, scene.materials);
  std::vector<Prescribed> held;
  for (int i : mesh.node_sets.at("y_min"))
    for (int k = 0; k < 3; ++k) held.push_back({3 * i + k, 0});
  scene.dofs = number_dofs(mesh.n_nodes(), held).dofs;
  const auto& top = mesh.node_sets.at("y_max");
  const RigidContact presses{
      "presses", Sphere{2.5, {0, 5.5, 0}}, 0.3, top, {{1, Vec3(0.2, -0.5, 0)}}},
      stays{"stays", Sphere{1, {3, 20, 0}}, 0.3, top, {{1, Vec3(0, -1, 0)}}};
  test::HowToSolve how;
  how.path.first = how.path.largest = 0.25;
  how.solver = NewtonOptions{.relative = 1e-11};
  const auto with = [&](const std::vector<RigidContact>& contacts) {
    Scene s = scene;
    s.contacts = contacts;
    return test::solved(mesh, s, std::nullopt, how).steps;
  };
  const auto alone = with({presses});
  CHECK(alone.back().force_ind.norm() > 0.1);
  for (const auto& both : {with({presses, stays}), with({stays, presses})}) {
    REQUIRE(both.size() == alone.size());
    for (std::size_t s = 0; s < alone.size(); ++s)
      CHECK((both[s].force_ind - alone[s].force_ind).norm() < 1e-9);
  }
}
