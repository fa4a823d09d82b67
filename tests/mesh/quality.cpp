#include "mechanics/mesh/quality.hpp"

#include "support/block.hpp"

#include <doctest/doctest.h>

#include "core/base/error.hpp"
#include "mesh/cells.hpp"
#include "support/near.hpp"

using namespace langer;
using example::one_cell;

TEST_CASE("quality of a turned brick: edges, aspect, Jacobian and volume in closed form") {
  const Mat3 R = example::turn(25, {1, 2, 3});
  const Quality q =
      quality(one_cell([&](const Vec3& x) { return Vec3(R * Vec3(2 * x[0], x[1], 0.5 * x[2])); }));
  CHECK(q.volume == near(8, 1e-14));
  CHECK(q.least_jacobian == near(1, 1e-14));  // 2 * 1 * 0.5
  CHECK(q.least_scaled_jacobian == near(1, 1e-14));
  CHECK(q.shortest_edge == near(1, 1e-14));
  CHECK(q.longest_edge == near(4, 1e-14));
  CHECK(q.largest_aspect == near(4, 1e-14));
}

TEST_CASE("a cell sheared by 45 degrees has the scaled Jacobian 1/sqrt(2)") {
  const Quality q = quality(one_cell([](const Vec3& x) { return Vec3(x[0] + x[1], x[1], x[2]); }));
  CHECK(q.least_scaled_jacobian == near(1 / std::sqrt(2.0), 1e-14));
}

TEST_CASE("the Jacobian is the derivative of the position") {
  Mesh mesh = one_cell(
      [](const Vec3& x) { return Vec3(x[0] * (1 + 0.2 * x[1]), x[1] + 0.1 * x[2] * x[0], x[2]); });
  const Vec3 xi(0.3, -0.2, 0.5);
  const Mat3 J = jacobian(mesh, 0, xi);
  const auto position = [&](const Vec3& at) {
    Vec3 x = Vec3::Zero();
    for (int a = 0; a < 8; ++a) x += Hex8::shape(at)[a] * mesh.X[a];
    return x;
  };
  for (int k = 0; k < 3; ++k) {
    const Vec3 h = 1e-3 * Vec3::Unit(k);  // the map is linear along each edge: no truncation error
    CHECK((J.col(k) - (position(xi + h) - position(xi - h)) / 2e-3).norm() < 1e-12);
  }
}

TEST_CASE("a folded, a flat or an inverted cell is refused with its number, place and value") {
  const auto refusal = [](const Mesh& mesh) -> std::string {
    try {
      refuse_folded(quality(mesh), "geometry.block");
    } catch (const Failure& failure) {
      CHECK(failure.code() == Exit::config);
      return failure.what();
    }
    return "";
  };
  CHECK(refusal(test::cube(2)) == "");
  Mesh folded = test::cube(2);
  folded.X[folded.cell(5)[6]] = folded.X[folded.cell(5)[0]] -
                                Vec3(0.1, 0.1, 0.1);  // a corner pushed through the opposite one
  const std::string words = refusal(folded);
  CHECK(words.find("geometry.block: cell 5 is folded: Jacobian -") != std::string::npos);
  CHECK(words.find("mm^3 at (") != std::string::npos);
  CHECK(refusal(one_cell([](const Vec3& x) { return Vec3(x[0], x[1], 0); })) != "");
  CHECK(refusal(one_cell([](const Vec3& x) { return Vec3(x[0], x[1], -x[2]); })) != "");
}

TEST_CASE(
    "two nodes at one place are found, however the rounding falls, and neighbours are not taken for them") {
  for (double shift : {0.0, 1e-12, 3e-9, 0.1234567}) {
    CAPTURE(shift);
    Mesh mesh = test::cube(3);
    for (Vec3& X : mesh.X) X.array() += shift;
    CHECK_FALSE(coincident_nodes(mesh, 1e-9));
    mesh.X.push_back(mesh.X[17] + Vec3(2e-10, -1e-10, 3e-10));
    const auto pair = coincident_nodes(mesh, 1e-9);
    REQUIRE(pair);
    CHECK((*pair)[0] == 17);
    CHECK((*pair)[1] == mesh.n_nodes() - 1);
  }
}
