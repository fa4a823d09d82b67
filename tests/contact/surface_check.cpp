// An indenter against the whole boundary, between nodes too: what is found is what a dense sampling
// of every facet finds.
#include "mechanics/contact/surface_check.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/mesh/select.hpp"
#include "support/block.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

using Random = std::mt19937;
double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
Vec3 direction(Random& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}
std::array<double, 3> as_array(const Vec3& v) { return {v[0], v[1], v[2]}; }

Facets box(const Vec3& middle, double half) {
  Triangles t;
  for (int k = 0; k < 8; ++k)
    t.points.push_back(middle +
                       half * Vec3(Hex8::corner[k][0], Hex8::corner[k][1], Hex8::corner[k][2]));
  for (const auto& f : Hex8::facet) {
    t.corners.push_back({f[0], f[1], f[2]});
    t.corners.push_back({f[0], f[2], f[3]});
  }
  Facets facets;
  facets.rounding = 0.1 * half, facets.tree = std::make_shared<TriangleTree>(t);
  return facets;
}

Indenter indenter(Random& random, int kind, const Vec3& place, double size) {
  const auto p = as_array(place);
  if (kind == 0) return Sphere{size, p};
  if (kind == 1)
    return Ellipsoid{{size * between(random, 0.5, 2), size, size * between(random, 0.5, 2)}, p};
  if (kind == 2) return Cylinder{size, 0.2 * size, p, as_array(direction(random))};
  if (kind == 3) return Plane{p, as_array(direction(random))};
  return box(place, size);
}

Mesh mesh_of(CellType type) {
  Mesh mesh = test::block({-4, -2.5, -1, 0, 1, 2.5, 4}, {0, 1.5, 3}, {-4, -2, -0.7, 0.7, 2, 4});
  return type == CellType::hex8 ? mesh : test::raised_block(mesh, type);
}

// least gap over every facet at 41 x 41 points of it
double sampled(const Mesh& mesh, const std::vector<Vec3>& u, const Indenter& shape, double low,
               double high) {
  const ReferenceCell& cell = reference(nodes_per_cell(mesh.type));
  double least = 1e300;
  for (const Facet& facet : boundary(mesh)) {
    const auto& local = cell.facet[facet.local];
    const auto nodes = mesh.cell(facet.cell);
    const bool triangle = mesh.type == CellType::tet15;
    for (int i = 0; i <= 40; ++i)
      for (int j = 0; j <= (triangle ? 40 - i : 40); ++j) {
        const double s = low + (high - low) * i / 40, t = low + (high - low) * j / 40;
        const auto corner = [&](int k) {
          return cell.node[local[k]];
        };
        const Vec3 xi =
            triangle ? Vec3((1 - s - t) * corner(0) + s * corner(1) + t * corner(2))
                     : Vec3(0.25 * ((1 - s) * (1 - t) * corner(0) + (1 + s) * (1 - t) * corner(1) +
                                    (1 + s) * (1 + t) * corner(2) + (1 - s) * (1 + t) * corner(3)));
        const VecX N = cell.shape(xi);
        Vec3 x = Vec3::Zero();
        for (std::size_t a = 0; a < nodes.size(); ++a) x += N[a] * (mesh.X[nodes[a]] + u[nodes[a]]);
        least = std::min(least, shape_at(shape, x).gap);
      }
  }
  return least;
}

}  // namespace

TEST_CASE(
    "the deepest point of the boundary is the one that a dense sampling finds, for any shape at any place") {
  Random random(17);
  int entered = 0;
  for (CellType type : {CellType::hex8, CellType::hex27, CellType::tet15}) {
    const Mesh mesh = mesh_of(type);
    const SurfaceCheck check(mesh);
    for (int trial = 0; trial < 25; ++trial) {
      std::vector<Vec3> u;
      for (std::size_t i = 0; i < mesh.X.size(); ++i)
        u.push_back(between(random, 0, 0.1) * direction(random));
      const Vec3 place(between(random, -5, 5), between(random, 2, 4.5), between(random, -5, 5));
      const double size = between(random, 0.15, 1.5);
      const RigidContact contact{"s", indenter(random, trial % 5, place, size), 0, {}, {}};
      const SurfaceLook look = check.look(contact, u, Vec3::Zero());
      const double least = sampled(mesh, u, contact.shape, type == CellType::tet15 ? 0 : -1, 1);
      CAPTURE(trial);
      CAPTURE(size);
      CHECK(look.distance <= least + 0.01 * std::abs(least) + 1e-6);
      CHECK(look.distance >= least - 0.05);  // sampling misses little
      CHECK(look.facet.depth == near(std::max(0.0, -look.distance)));
      // what is deepest relative to its cells is no deeper than the deepest point
      CHECK((look.unresolved.depth > 0) == (look.facet.depth > 0));
      CHECK(look.unresolved.depth <= look.facet.depth);
      entered += look.facet.depth > 0;
    }
  }
  CHECK(entered > 25);
}

TEST_CASE(
    "a shape in the middle of a body, which it touches nowhere, is swallowed; one beside it is not") {
  Random random(5);
  for (CellType type : {CellType::hex8, CellType::hex27, CellType::tet15}) {
    const Mesh mesh = mesh_of(type);
    const SurfaceCheck check(mesh);
    const std::vector<Vec3> u(mesh.X.size(), Vec3::Zero());
    for (int trial = 0; trial < 12; ++trial) {
      const int kind = std::array{0, 1, 4}[trial % 3];
      const Vec3 inside(between(random, -3, 3), between(random, 1, 2), between(random, -3, 3));
      const Vec3 moved = trial % 2 ? Vec3(0, 10, 0) : Vec3(12, 0, 0);
      const RigidContact contact{
          "s", indenter(random, kind, inside, between(random, 0.05, 0.3)), 0, {}, {}};
      CHECK(check.look(contact, u, Vec3::Zero()).swallowed);
      CHECK_FALSE(check.look(contact, u, moved).swallowed);
      CHECK(check.look(contact, u, moved).distance > 1);
    }
  }
}

TEST_CASE(
    "nodes inside that are no candidates are found, candidates are not counted; the depth is that of the node") {
  Random random(11);
  const Mesh mesh = mesh_of(CellType::hex8);
  const SurfaceCheck check(mesh);
  const std::vector<Vec3> u(mesh.X.size(), Vec3::Zero());
  for (int trial = 0; trial < 40; ++trial) {
    RigidContact contact{
        "s",
        indenter(random, trial % 5, Vec3(between(random, -4, 4), 3.3, between(random, -4, 4)), 1.2),
        0,
        {},
        {}};
    std::vector<char> outer(mesh.X.size(), 0);
    for (const Facet& f : boundary(mesh))
      for (int n : facet_nodes(mesh, f)) outer[n] = 1;
    double deepest = 0;
    for (int n = 0; n < mesh.n_nodes(); ++n) {
      if (random() % 2) {
        contact.nodes.push_back(n);
        continue;
      }
      if (outer[n]) deepest = std::max(deepest, -shape_at(contact.shape, mesh.X[n]).gap);
    }
    CHECK(check.look(contact, u, Vec3::Zero()).node.depth == near(deepest));
  }
}

TEST_CASE(
    "without a set the candidates are what the indenter sweeps of the boundary, and not all of it") {
  Random random(23);
  const Mesh mesh =
      test::block(test::even(-10, 10, 40), test::even(0, 3, 3), test::even(-10, 10, 40));
  const SurfaceCheck check(mesh);
  for (int trial = 0; trial < 20; ++trial) {
    const double size = between(random, 0.4, 2), x = between(random, -6, 6),
                 z = between(random, -6, 6);
    RigidContact contact{"s", Sphere{size, {x, 3 + size, z}}, 0, {}, {}};
    const Vec3 down(0, -between(random, 0.1, 0.8), 0),
        along(between(random, -3, 3), 0, between(random, -3, 3));
    contact.motion = {{0.5, down}, {1, down + along}};
    const std::vector<int> nodes = check.reached(contact, 0);
    CHECK(std::is_sorted(nodes.begin(), nodes.end()));
    CHECK(nodes.size() < 0.5 * mesh.X.size());
    for (const Facet& f : boundary(mesh))
      for (int n : facet_nodes(mesh, f))
        for (double t : {0.1, 0.3, 0.5, 0.6, 0.75, 0.9, 1.0})
          if (shape_at(contact.shape, mesh.X[n] - indenter_displacement(contact, t)).gap < 0)
            CHECK(std::binary_search(nodes.begin(), nodes.end(), n));
  }
}
