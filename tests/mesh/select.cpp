#include "mechanics/mesh/select.hpp"

#include <doctest/doctest.h>

#include "mesh/cells.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {
// 4 x 2 x 4 cells of edge 1, x and z from -2 to 2, y from 0 to 2; node number (k * 3 + j) * 5 + i
Mesh block() {
  return test::block(test::even(-2, 2, 4), test::even(0, 2, 2), test::even(-2, 2, 4));
}
std::vector<int> top(const Mesh& mesh) { return select(mesh, OnPlane{"y", 2}, all_nodes(mesh)); }
}  // namespace

TEST_CASE("a plane holds its nodes, limits included, and no others") {
  const Mesh mesh = block();
  for (const char* axis : {"x", "y", "z"}) {
    const int i = axis[0] - 'x';
    const auto nodes = select(mesh, OnPlane{axis, 1}, all_nodes(mesh));
    CHECK(nodes.size() == (i == 1 ? 25 : 15));
    for (int n : nodes) CHECK(mesh.X[n][i] == 1);
  }
  CHECK(select(mesh, OnPlane{"x", 0.5}, all_nodes(mesh)).empty());
}

TEST_CASE("a box and a cylinder hold what lies inside or on them") {
  const Mesh mesh = block();
  CHECK(select(mesh, InBox{{-1, 0, -1}, {1, 2, 1}}, all_nodes(mesh)).size() == 27);
  CHECK(select(mesh, InBox{{0.1, 0, 0.1}, {0.9, 2, 0.9}}, all_nodes(mesh)).empty());
  CHECK(select(mesh, InCylinder{"y", {0, 0, 0}, 1}, top(mesh)).size() ==
        5);  // the centre and four at exactly 1
  CHECK(select(mesh, InCylinder{"y", {0, 7, 0}, 1.5}, all_nodes(mesh)).size() == 27);
  CHECK(select(mesh, InCylinder{"x", {0, 0, 2}, 0.5}, all_nodes(mesh)).size() == 5);
  CHECK(select(mesh, InCylinder{"y", {0, 0, 0}, 2, 1}, top(mesh)).size() ==
        12);  // a ring: less the centre; its four are at exactly 1
}

TEST_CASE("the nearest node is one, of several equally near the first") {
  const Mesh mesh = block();
  const auto one = select(mesh, NearestNode{{0.9, 2.2, -1.1}}, all_nodes(mesh));
  REQUIRE(one.size() == 1);
  CHECK(mesh.X[one[0]] == Vec3(1, 2, -1));
  const auto tie = select(mesh, NearestNode{{0.5, 2, 0.5}}, all_nodes(mesh));
  REQUIRE(tie.size() == 1);
  CHECK(mesh.X[tie[0]] == Vec3(0, 2, 0));
  CHECK(mesh.X[select(mesh, NearestNode{{0, 0, 0}}, top(mesh)).at(0)] == Vec3(0, 2, 0));
}

TEST_CASE(
    "the boundary is closed: its normals sum to zero, its flux of position is three times the volume") {
  Mesh mesh = block();
  test::distort(mesh, 0.1);
  Vec3 sum = Vec3::Zero();
  double flux = 0;
  const auto facets = boundary(mesh);
  CHECK(facets.size() == 2 * (4 * 2 + 4 * 4 + 2 * 4));
  for (const Facet& f : facets) {
    Vec3 x[4];
    for (int a = 0; a < 4; ++a) x[a] = mesh.X[mesh.cell(f.cell)[Hex8::facet[f.local][a]]];
    for (double s : {-1, 1})  // 2 x 2 Gauss points integrate a bilinear facet exactly
      for (double t : {-1, 1}) {
        const double a = s / std::sqrt(3.0), b = t / std::sqrt(3.0);
        const Vec3 ds = ((1 - b) * (x[1] - x[0]) + (1 + b) * (x[2] - x[3])) / 4;
        const Vec3 dt = ((1 - a) * (x[3] - x[0]) + (1 + a) * (x[2] - x[1])) / 4;
        const Vec3 at = ((1 - a) * (1 - b) * x[0] + (1 + a) * (1 - b) * x[1] +
                         (1 + a) * (1 + b) * x[2] + (1 - a) * (1 + b) * x[3]) /
                        4;
        sum += ds.cross(dt);
        flux += at.dot(ds.cross(dt));
      }
  }
  CHECK(sum.norm() < 1e-13 * 64);  // rounding of 64 facets of area 1
  double volume = 0;
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int g = 0; g < 8; ++g) {
      Mat3 J = Mat3::Zero();
      const Hex8::Gradient dN = Hex8::gradient(Hex8::gauss(g));
      for (int a = 0; a < 8; ++a) J += mesh.X[mesh.cell(e)[a]] * dN.row(a);
      volume += J.determinant();
    }
  CHECK(flux == near(3 * volume, 1e-13));
}

TEST_CASE("the sides of a block are named as nodes and facets, top and bottom along y") {
  Mesh mesh = block();
  mesh.node_sets.clear();
  name_sides(mesh);
  CHECK(mesh.node_sets.size() == 8);
  CHECK(mesh.node_sets.at("top") == mesh.node_sets.at("y_max"));
  CHECK(mesh.node_sets.at("bottom") == mesh.node_sets.at("y_min"));
  CHECK(mesh.node_sets.at("x_min").size() == 15);
  CHECK(mesh.facet_sets.at("x_min").size() == 8);
  CHECK(mesh.facet_sets.at("top").size() == 16);
  const int expected[] = {0, 1, 2, 3, 4, 5};  // cells of this block have their edges along x, y, z
  const char* names[] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  for (int i = 0; i < 6; ++i)
    for (const Facet& f : mesh.facet_sets.at(names[i])) CHECK(f.local == expected[i]);
}
