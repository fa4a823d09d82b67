// The O-grid in the x-z plane, quarter by quarter (s = 0..3 stands for +x, +z, -x, -z):
//   corners of square s and s+1 at 45 degrees, arcs between them on each ring, the sides of the block outside.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "geometry/block.hpp"
#include "geometry/grading.hpp"
#include "geometry/session.hpp"
#include "mesh/order.hpp"

namespace langer {

std::vector<Complaint> GradedBlock::complaints() const {
  std::vector<Complaint> found;
  long long across = outer_cells;
  for (const Ring& ring : rings) across += ring.cells;
  if (const long long cells = layers * (1LL * core.cells * core.cells + 4LL * core.cells * across); cells > most_cells)
    found.push_back({"layers", fmt::format("found {} cells in all", cells), fmt::format("at most {}", most_cells), ""});
  if (core.cells % 2 != 0) found.push_back({"core.cells", fmt::format("found {}", core.cells), "an even number", ""});
  if (rings.empty()) found.push_back({"rings", "found an empty list", "at least one ring", ""});
  double inside = core.half_width * std::numbers::sqrt2;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (rings[i].radius <= inside)
      found.push_back({fmt::format("rings[{}].radius", i), fmt::format("found {}", rings[i].radius),
                       fmt::format("more than {:.6g}, the {}", inside, i == 0 ? "core's corner" : "ring inside it"), ""});
    inside = rings[i].radius;
  }
  if (const double half = 0.5 * std::min(size[0], size[2]); inside >= half)
    found.push_back({fmt::format("rings[{}].radius", rings.empty() ? 0 : rings.size() - 1), fmt::format("found {}", inside),
                     fmt::format("less than {}, half the block's width", half), ""});
  return found;
}

namespace {

namespace geo = gmsh::model::geo;
using Corners = std::array<int, 4>;  // gmsh tags, one for each quarter

Corners closed_by(const Corners& corners, auto curve, int cells) {
  Corners curves;
  for (int s = 0; s < 4; ++s) {
    curves[s] = curve(corners[s], corners[(s + 1) % 4]);
    geo::mesh::setTransfiniteCurve(curves[s], cells + 1);
  }
  return curves;
}

Corners spokes(const Corners& inner, const Corners& outer, int cells, double growth) {
  Corners curves;
  for (int s = 0; s < 4; ++s) {
    curves[s] = geo::addLine(inner[s], outer[s]);
    geo::mesh::setTransfiniteCurve(curves[s], cells + 1, "Progression", growth);
  }
  return curves;
}

int surface(const std::vector<int>& loop) {
  const int tag = geo::addPlaneSurface({geo::addCurveLoop(loop)});
  geo::mesh::setTransfiniteSurface(tag);
  geo::mesh::setRecombine(2, tag);
  return tag;
}

// ratio of neighbours so that the outer cells continue with about the length of the last ring's
double growth_of(const GradedBlock& b, double from, double to) {
  const std::size_t last = b.rings.size() - 1;
  const double inside = last == 0 ? b.core.half_width : b.rings[last - 1].radius;
  const double edge = (b.rings[last].radius - inside) / b.rings[last].cells;
  if (edge * b.outer_cells >= to - from) return 1;
  const std::vector<double> lines = refined(to - from, b.outer_cells, edge, 0, "geometry.graded_block.outer_cells");
  return lines.size() < 3 ? 1 : (lines[2] - lines[1]) / (lines[1] - lines[0]);
}

gmsh::vectorpair plan(const GradedBlock& b) {
  const double y = b.origin[1], half_x = 0.5 * b.size[0], half_z = 0.5 * b.size[2];
  const double x0 = b.origin[0] + half_x, z0 = b.origin[2] + half_z;
  // corners at 45 degrees on either side of +x, +z, -x, -z
  const auto square = [&](double dx, double dz) {
    return Corners{geo::addPoint(x0 + dx, y, z0 - dz), geo::addPoint(x0 + dx, y, z0 + dz), geo::addPoint(x0 - dx, y, z0 + dz),
                   geo::addPoint(x0 - dx, y, z0 - dz)};
  };
  const auto straight = [](int a, int c) { return geo::addLine(a, c); };
  const int centre = geo::addPoint(x0, y, z0);
  const auto arc = [&](int a, int c) { return geo::addCircleArc(a, centre, c); };

  const int n = b.core.cells;
  Corners inner = square(b.core.half_width, b.core.half_width), inner_curves = closed_by(inner, straight, n);
  gmsh::vectorpair surfaces{{2, surface({inner_curves[0], inner_curves[1], inner_curves[2], inner_curves[3]})}};
  const auto surround = [&](const Corners& outer, const Corners& outer_curves, int cells, double growth) {
    const Corners between = spokes(inner, outer, cells, growth);
    for (int s = 0; s < 4; ++s)
      surfaces.push_back({2, surface({between[s], outer_curves[s], -between[(s + 1) % 4], -inner_curves[s]})});
    inner = outer, inner_curves = outer_curves;
  };
  for (const Ring& ring : b.rings) {
    const double corner = ring.radius / std::numbers::sqrt2;
    const Corners outer = square(corner, corner);
    surround(outer, closed_by(outer, arc, n), ring.cells, 1);
  }
  const Corners sides = square(half_x, half_z);
  surround(sides, closed_by(sides, straight, n), b.outer_cells, growth_of(b, b.rings.back().radius, std::min(half_x, half_z)));
  return surfaces;
}

std::vector<double> layer_heights(const GradedBlock& b) {
  const double low = b.origin[1], high = low + b.size[1];
  return b.top ? lines_to_top(low, high, b.layers, b.top->edge, "geometry.graded_block.top.edge")
               : even_lines(low, high, b.layers);
}

}  // namespace

std::vector<Complaint> contradictions(const GradedBlock& b, const Points& points) {
  std::vector<Complaint> found = complaints_of([&] { layer_heights(b); });
  const auto growth = [&] { growth_of(b, b.rings.back().radius, 0.5 * std::min(b.size[0], b.size[2])); };
  for (Complaint& c : complaints_of(growth)) found.push_back(std::move(c));
  for (const auto& [name, x] : points)
    for (int i = 0; i < 3; ++i)
      if (const double low = b.origin[i], high = low + b.size[i]; x[i] < low || x[i] > high)
        found.push_back({"points." + name, fmt::format("{} = {} is outside the block", "xyz"[i], x[i]),
                         fmt::format("{} to {}", low, high), ""});
  return found;
}

Mesh mesh_of(const GradedBlock& b, const Points&, std::vector<std::string>&) {
  const double low = b.origin[1];
  const std::vector<double> y = layer_heights(b);
  Mesh mesh = meshed_by_gmsh("geometry.graded_block", [&] {
    std::vector<double> heights;
    for (int k = 1; k <= b.layers; ++k) heights.push_back((y[k] - low) / b.size[1]);
    gmsh::vectorpair extruded;
    geo::extrude(plan(b), 0, b.size[1], 0, extruded, std::vector<int>(heights.size(), 1), heights, true);
    geo::synchronize();
  });
  for (Vec3& x : mesh.X)  // gmsh's heights carry rounding
    for (double line : y)
      if (std::abs(x[1] - line) < 1e-9 * b.size[1]) x[1] = line;
  turn_cells(mesh);
  const Vec3 axis(b.origin[0] + 0.5 * b.size[0], 0, b.origin[2] + 0.5 * b.size[2]);
  make_symmetric(mesh, axis);
  turn_outwards(mesh, axis, b.core.half_width, b.blocks);
  number_in_order(mesh);
  return mesh;
}

}  // namespace langer
