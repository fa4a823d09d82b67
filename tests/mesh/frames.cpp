#include "mechanics/mesh/frames.hpp"

#include <doctest/doctest.h>

#include "mesh/cells.hpp"
#include "support/near.hpp"

using namespace langer;
using example::one_cell;
using example::turn;

TEST_CASE("frames are orthonormal and right-handed, on distorted cells too") {
  Mesh mesh = test::cube(3);
  test::distort(mesh, 0.2);
  for (Frames kind : {Frames::global, Frames::element_edges})
    for (const Mat3& frame : frames(mesh, kind)) {
      CHECK((frame.transpose() * frame - Mat3::Identity()).norm() <
            1e-14);  // rounding of nine products
      CHECK(frame.determinant() == near(1, 1e-14));
    }
}

TEST_CASE("the frame of the edges turns with the cell, the global frame does not") {
  const Mat3 R = turn(37, {0.3, 1, -0.2});
  const Mesh mesh =
      one_cell([&](const Vec3& x) { return Vec3(R * Vec3(2 * x[0], x[1], 3 * x[2])); });
  CHECK((frames(mesh, Frames::element_edges)[0] - R).norm() < 1e-14);
  CHECK(frames(mesh, Frames::global)[0] == Mat3::Identity());
}

TEST_CASE("in a skewed cell e_x follows the xi edges and e_y stays in their plane with eta") {
  const Mesh mesh =
      one_cell([](const Vec3& x) { return Vec3(x[0] + 0.5 * x[1], x[1], x[2] + 0.2 * x[1]); });
  const Mat3 frame = frames(mesh, Frames::element_edges)[0];
  CHECK((frame.col(0) - Vec3(1, 0, 0)).norm() < 1e-15);
  CHECK(std::abs(frame.col(2).dot(Vec3(0.5, 1, 0.2))) < 1e-15);
}
