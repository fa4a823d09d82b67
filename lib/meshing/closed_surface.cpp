#include "meshing/closed_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/text.hpp"
#include "meshing/seal_holes.hpp"

namespace langer {

std::map<Edge, EdgeUse> edges_of(const Triangles& surface) {
  std::map<Edge, EdgeUse> edges;
  for (const std::array<int, 3>& triangle : surface.corners) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = triangle[k];
      const int to = triangle[(k + 1) % 3];
      if (from < to)
        ++edges[{from, to}].forward;
      else
        ++edges[{to, from}].backward;
    }
  }
  return edges;
}

namespace {

// The middles of the first edges, for a message.
std::string places(const Triangles& surface, const std::vector<Edge>& edges) {
  constexpr std::size_t most = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, edges.size()); ++i) {
    const Vec3& a = surface.points[static_cast<std::size_t>(edges[i].first)];
    const Vec3& b = surface.points[static_cast<std::size_t>(edges[i].second)];
    const Vec3 middle = 0.5 * (a + b);
    if (i > 0) text += ", ";
    text += fmt::format("({:.4g}, {:.4g}, {:.4g})", middle[0], middle[1], middle[2]);
  }
  if (edges.size() > most) text += " and others";
  return text;
}

std::string counted_edges(std::size_t n) {
  if (n == 1) return "1 edge";
  return fmt::format("{} edges", n);
}

}  // namespace

// A surface encloses a volume when each of its edges belongs to exactly two triangles that run
// along it in opposite directions. Three faults are distinguished, since each has its own repair: a
// hole, a wall inside, and triangles with opposite normals. The first kind found is reported.
void require_closed(const Triangles& surface, const std::string& shown_name) {
  std::vector<Edge> open;
  std::vector<Edge> crowded;
  std::vector<Edge> turned;
  for (const auto& [edge, use] : edges_of(surface)) {
    const int n = use.forward + use.backward;
    if (n == 1)
      open.push_back(edge);
    else if (n > 2)
      crowded.push_back(edge);
    else if (use.forward != 1)
      turned.push_back(edge);
  }
  const auto refuse = [&](const std::vector<Edge>& edges, const std::string& found,
                          const std::string& hint) {
    throw Failure(
        Exit::input,
        Error{{shown_name},
              "",
              fmt::format("{}; {} with the middle{} {}", found, counted_edges(edges.size()),
                          plural_s(edges.size()), places(surface, edges)),
              "a closed surface, each of whose edges belongs to two triangles",
              hint});
  };
  if (!open.empty()) {
    std::string hint =
        "fill the hole in the program that made the file (Meshmixer, MeshLab: Close Holes)";
    double widest = 0;
    for (const Hole& hole : holes_of(surface)) widest = std::max(widest, hole.width);
    // rounded upwards, so that the advice works
    if (widest > 0)
      hint = fmt::format(
                 "seal: {:.3g} fills holes of this width (times scale, where that is given); or ",
                 1.01 * widest) +
             hint;
    refuse(open, "the surface is open", hint);
  }
  if (!crowded.empty())
    refuse(crowded, "more than two triangles meet at one edge",
           "remove walls inside and triangles that are there twice");
  if (!turned.empty())
    refuse(turned, "neighbouring triangles have opposite orientations",
           "orient all normals outwards (MeshLab: Re-Orient all faces coherently)");
}

// By the divergence theorem: the sum of signed tetrahedra between a point and each triangle. The
// sign depends on the orientation of the surface, so the absolute value is returned.
double enclosed_volume(const Triangles& surface) {
  double six_volumes = 0;
  for (const std::array<int, 3>& c : surface.corners) {
    // around the first point, so that a body far from the origin loses no digits
    const Vec3& origin = surface.points.front();
    const Vec3 a = surface.points[static_cast<std::size_t>(c[0])] - origin;
    const Vec3 b = surface.points[static_cast<std::size_t>(c[1])] - origin;
    const Vec3 d = surface.points[static_cast<std::size_t>(c[2])] - origin;
    six_volumes += a.dot(b.cross(d));
  }
  return std::abs(six_volumes) / 6;
}

}  // namespace langer
