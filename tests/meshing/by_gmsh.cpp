// Our structured meshes beside those that gmsh makes of the same lines and arcs.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "mechanics/mesh/quality.hpp"
#include "mechanics/mesh/select.hpp"
#include "meshing/block.hpp"
#include "meshing/gmsh/gmsh_session.hpp"
#include "meshing/msh_types.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

namespace geo = gmsh::model::geo;

struct Made {
  std::vector<Vec3> X;
  std::vector<std::vector<int>> cells;  // their nodes, as gmsh orders them
};

Made meshed() {
  gmsh::model::mesh::generate(3);
  std::vector<std::size_t> tags, elements, nodes;
  std::vector<double> X, parametric;
  gmsh::model::mesh::getNodes(tags, X, parametric);
  std::map<std::size_t, std::size_t> place;
  for (std::size_t i = 0; i < tags.size(); ++i) place[tags[i]] = i;
  gmsh::model::mesh::getElementsByType(msh_type::hexahedron, elements, nodes);
  Made made;
  std::map<std::size_t, int> number;  // of nodes that cells have; the centre of arcs is none
  for (std::size_t e = 0; e < elements.size(); ++e) {
    made.cells.emplace_back();
    for (std::size_t a = 0; a < 8; ++a) {
      const auto [at, is_new] =
          number.try_emplace(nodes[8 * e + a], static_cast<int>(made.X.size()));
      if (is_new) made.X.emplace_back(X.data() + 3 * place.at(nodes[8 * e + a]));
      made.cells.back().push_back(at->second);
    }
  }
  return made;
}

// a point extruded along x, z and y, cell by cell
Made block_by_gmsh(const std::array<std::vector<double>, 3>& lines) {
  const GmshSession session;
  gmsh::vectorpair shape{{0, geo::addPoint(lines[0][0], lines[1][0], lines[2][0])}};
  for (int i : {0, 2, 1}) {
    const std::vector<double>& x = lines[static_cast<std::size_t>(i)];
    const double length = x.back() - x.front();
    std::vector<double> heights;
    for (std::size_t k = 1; k < x.size(); ++k) heights.push_back((x[k] - x.front()) / length);
    gmsh::vectorpair extruded, next;
    geo::extrude(shape, i == 0 ? length : 0, i == 1 ? length : 0, i == 2 ? length : 0, extruded,
                 std::vector<int>(heights.size(), 1), heights, true);
    for (const auto& [dim, tag] : extruded)
      if (dim == shape[0].first + 1) next.push_back({dim, tag});
    shape = {next.at(0)};
  }
  geo::synchronize();
  return meshed();
}

// transfinite squares, rings and sides; `growth` is the ratio of neighbours outside the last ring
Made o_grid_by_gmsh(const GradedBlock& b, double growth) {
  using Corners = std::array<int, 4>;
  const GmshSession session;
  const double y = b.origin[1], half_x = 0.5 * b.size[0], half_z = 0.5 * b.size[2],
               x0 = b.origin[0] + half_x, z0 = b.origin[2] + half_z;
  const auto square = [&](double dx, double dz) {
    return Corners{geo::addPoint(x0 + dx, y, z0 - dz), geo::addPoint(x0 + dx, y, z0 + dz),
                   geo::addPoint(x0 - dx, y, z0 + dz), geo::addPoint(x0 - dx, y, z0 - dz)};
  };
  const auto closed = [&](const Corners& corners, auto curve) {
    Corners curves;
    for (std::size_t s = 0; s < 4; ++s)
      geo::mesh::setTransfiniteCurve(curves[s] = curve(corners[s], corners[(s + 1) % 4]),
                                     b.core.cells + 1);
    return curves;
  };
  const auto surface = [](const std::vector<int>& loop) {
    const int tag = geo::addPlaneSurface({geo::addCurveLoop(loop)});
    geo::mesh::setTransfiniteSurface(tag);
    geo::mesh::setRecombine(2, tag);
    return tag;
  };
  const auto straight = [](int a, int c) {
    return geo::addLine(a, c);
  };
  const int centre = geo::addPoint(x0, y, z0);
  const auto arc = [&](int a, int c) {
    return geo::addCircleArc(a, centre, c);
  };
  Corners inner = square(b.core.half_width, b.core.half_width),
          inner_curves = closed(inner, straight);
  gmsh::vectorpair surfaces{
      {2, surface({inner_curves[0], inner_curves[1], inner_curves[2], inner_curves[3]})}},
      extruded;
  const auto surround = [&](const Corners& outer, const Corners& curves, int cells, double ratio) {
    Corners spokes;
    for (std::size_t s = 0; s < 4; ++s)
      geo::mesh::setTransfiniteCurve(spokes[s] = geo::addLine(inner[s], outer[s]), cells + 1,
                                     "Progression", ratio);
    for (std::size_t s = 0; s < 4; ++s)
      surfaces.push_back(
          {2, surface({spokes[s], curves[s], -spokes[(s + 1) % 4], -inner_curves[s]})});
    inner = outer, inner_curves = curves;
  };
  for (const Ring& ring : b.rings) {
    const Corners outer =
        square(ring.radius / std::numbers::sqrt2, ring.radius / std::numbers::sqrt2);
    surround(outer, closed(outer, arc), ring.cells, 1);
  }
  const Corners sides = square(half_x, half_z);
  surround(sides, closed(sides, straight), b.outer_cells, growth);
  geo::extrude(surfaces, 0, b.size[1], 0, extruded, {b.layers}, {1}, true);
  geo::synchronize();
  return meshed();
}

// the same nodes to `tolerance` mm, and cells of the same nodes
void check_same(const Mesh& ours, const Made& theirs, double tolerance) {
  REQUIRE(ours.X.size() == theirs.X.size());
  REQUIRE(static_cast<std::size_t>(ours.n_cells()) == theirs.cells.size());
  std::vector<int> twin;
  double furthest = 0;
  for (const Vec3& x : theirs.X) {
    int nearest = 0;
    for (int n = 1; n < ours.n_nodes(); ++n)
      if ((ours.X[n] - x).squaredNorm() < (ours.X[nearest] - x).squaredNorm()) nearest = n;
    twin.push_back(nearest);
    furthest = std::max(furthest, (ours.X[nearest] - x).norm());
  }
  CHECK(furthest < tolerance);
  std::vector<std::vector<int>> a, b;
  for (int e = 0; e < ours.n_cells(); ++e) {
    const auto nodes = ours.cell(e);
    a.emplace_back(nodes.begin(), nodes.end());
    std::sort(a.back().begin(), a.back().end());
  }
  for (std::vector<int> nodes : theirs.cells) {
    for (int& n : nodes) n = twin[static_cast<std::size_t>(n)];
    std::sort(nodes.begin(), nodes.end());
    b.push_back(nodes);
  }
  std::sort(a.begin(), a.end()), std::sort(b.begin(), b.end());
  CHECK(a == b);
  CHECK(quality(ours).least_jacobian > 0);
}

}  // namespace

TEST_CASE("a block has the nodes and cells that gmsh extrudes from the same grid lines") {
  const Block block{{-1, 0.5, 2}, {3, 2, 5}, {6, 4, 8}, TowardsCentre{0.4, 0.5}, TowardsTop{0.2}};
  std::vector<std::string> notes;
  const Mesh mesh = mesh_of(block, {{"P", Vec3(0, 1, 4)}}, notes);
  std::array<std::vector<double>, 3> lines;
  for (int i = 0; i < 3; ++i) {
    auto& of = lines[static_cast<std::size_t>(i)];
    for (const Vec3& x : mesh.X) of.push_back(x[i]);
    std::sort(of.begin(), of.end());
    of.erase(std::unique(of.begin(), of.end()), of.end());
    CHECK(of.size() == static_cast<std::size_t>(block.divisions[static_cast<std::size_t>(i)]) + 1);
  }
  check_same(mesh, block_by_gmsh(lines), 1e-12);
  // in order: by y, then z, then x
  for (int n = 1; n < mesh.n_nodes(); ++n) {
    const Vec3 &a = mesh.X[n - 1], &b = mesh.X[n];
    CHECK(std::array{a[1], a[2], a[0]} < std::array{b[1], b[2], b[0]});
  }
}

TEST_CASE("an O-grid has the nodes and cells of gmsh's transfinite squares, rings and sides") {
  GradedBlock block;
  block.origin = {-6, 1, -4}, block.size = {12, 3, 10};
  block.core = {1, 4}, block.rings = {{2, 3}, {3, 2}}, block.outer_cells = 3, block.layers = 2;
  std::vector<std::string> notes;
  const Mesh mesh = mesh_of(block, {}, notes);
  // the ratio of neighbours outside, along +z, where 0.5 mm cells of the last ring reach 2 mm
  // further
  std::vector<double> z;
  for (const Vec3& x : mesh.X)
    if (std::abs(x[0]) < 1e-9 && std::abs(x[1] - 1) < 1e-9 && x[2] > 1 + 3 - 1e-9)
      z.push_back(x[2]);
  std::sort(z.begin(), z.end());
  REQUIRE(z.size() == 4);
  const double growth = (z[2] - z[1]) / (z[1] - z[0]);
  CHECK(growth == near((z[3] - z[2]) / (z[2] - z[1])));
  CHECK(growth > 1.1);
  check_same(mesh, o_grid_by_gmsh(block, growth),
             1e-7);  // gmsh finds places on its curves by quadrature
}
