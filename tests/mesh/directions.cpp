// Directions of fibres by cell and family.
#include "mechanics/mesh/directions.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "support/block.hpp"

using namespace langer;

namespace {
Mesh layers() {
  Mesh mesh = test::block(test::even(0, 2, 2), test::even(0, 2, 2), test::even(0, 2, 2));
  mesh.bodies = {"a", "b"};
  mesh.body.assign(8, 0), mesh.body[3] = mesh.body[6] = 1;
  return mesh;
}
Vec3 at(double degrees) {
  const double alpha = degrees * std::numbers::pi / 180;
  return {std::cos(alpha), 0, std::sin(alpha)};
}
}  // namespace

TEST_CASE(
    "one list of directions stands for all cells where fibres and frames are the same everywhere") {
  const Mesh mesh = test::block(test::even(0, 4, 4), test::even(0, 4, 4), test::even(0, 4, 4));
  const Directions directions = make_directions(mesh, {{30, -30}});
  CHECK(directions.n_stored() == 1);
  CHECK(directions.n_families() == 2);
  CHECK_FALSE(directions.from_field());
  for (int e = 0; e < mesh.n_cells(); ++e) {
    REQUIRE(directions.of(e).size() == 2);
    for (int k : {0, 1}) CHECK(directions.of(e)[k] == fibre_direction(k == 0 ? 30 : -30));
  }
  CHECK((fibre_direction(30) - at(30)).norm() < 1e-15);
  CHECK(directions.of(mesh.n_cells()).empty());
  CHECK(make_directions(mesh, {{}}).n_families() == 0);
}

TEST_CASE(
    "each body has its own families, a part of the body the directions of its cells, and a field those that it gives") {
  const Mesh mesh = layers();
  const Directions plain = make_directions(mesh, {{20}, {60, 90, 0}});
  for (int e = 0; e < 8; ++e) CHECK(plain.of(e).size() == (e == 3 || e == 6 ? 3 : 1));
  CHECK(plain.n_stored() == 5);
  const int cells[] = {6, 3, 0};
  const Directions part = plain.of_cells(cells);
  CHECK(part.n_stored() == 2);
  CHECK(part.of(1)[2] == Vec3(1, 0, 0));
  CHECK(part.of(2)[0] == plain.of(0)[0]);

  // angles: further families keep theirs to the first; in the body without a field nothing changes
  const Directions turned =
      make_directions(mesh, {{20}, {60, 90, 0}}, {{}, std::vector<double>{10, 40}});
  CHECK(turned.from_field());
  CHECK(turned.of_cells(cells).from_field());
  CHECK(turned.of(0)[0] == plain.of(0)[0]);
  for (const auto& [e, alpha] : {std::pair{3, 10.0}, {6, 40.0}}) {
    CHECK((turned.of(e)[0] - at(alpha)).norm() < 1e-15);
    CHECK((turned.of(e)[1] - at(alpha + 30)).norm() < 1e-15);
    CHECK((turned.of(e)[2] - at(alpha - 60)).norm() < 1e-15);
  }
  // directions: the same, told by vectors
  const Directions measured =
      make_directions(mesh, {{20}, {60, 90, 0}}, {{}, std::vector<Vec3>{at(10), at(40)}});
  for (int e : {3, 6})
    for (int k : {0, 1, 2}) CHECK((measured.of(e)[k] - turned.of(e)[k]).norm() < 1e-15);
}
