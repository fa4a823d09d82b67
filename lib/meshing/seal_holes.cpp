#include "meshing/seal_holes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "meshing/closed_surface.hpp"

namespace langer {

namespace {

constexpr std::size_t most_points = 300;  // the work grows with their third power

const Vec3& point(const Triangles& surface, int i) {
  return surface.points[static_cast<std::size_t>(i)];
}

Hole hole_through(const Triangles& surface, std::vector<int> points) {
  Hole hole;
  for (std::size_t i = 0; i < points.size(); ++i) {
    hole.middle += point(surface, points[i]) / static_cast<double>(points.size());
    for (std::size_t j = 0; j < i; ++j)
      hole.width =
          std::max(hole.width, (point(surface, points[i]) - point(surface, points[j])).norm());
  }
  hole.points = std::move(points);
  return hole;
}

}  // namespace

std::vector<Hole> holes_of(const Triangles& surface) {
  // A triangle that fills the hole runs through its edges the other way.
  std::map<int, int> next;
  std::set<int> shared;  // points of several chains
  for (const auto& [edge, use] : edges_of(surface)) {
    if (use.forward + use.backward != 1) continue;
    auto [from, to] = edge;
    if (use.forward == 1) std::swap(from, to);
    if (!next.emplace(from, to).second) shared.insert(from);
  }
  std::vector<Hole> holes;
  while (!next.empty()) {
    const int first = next.begin()->first;
    std::vector<int> points;
    bool is_simple = true;
    for (int at = first;;) {
      points.push_back(at);
      is_simple = is_simple && !shared.contains(at);
      const auto found = next.find(at);
      if (found == next.end()) {  // used up, or of triangles with opposite orientations
        is_simple = false;
        break;
      }
      at = found->second;
      next.erase(found);
      if (at == first) break;
    }
    if (is_simple && points.size() >= 3) holes.push_back(hole_through(surface, std::move(points)));
  }
  return holes;
}

bool fill(const Hole& hole, Triangles& surface) {
  const std::size_t n = hole.points.size();
  if (n < 3 || n > most_points) return false;
  const auto place = [&](std::size_t i) -> const Vec3& {
    return point(surface, hole.points[i]);
  };
  // least[i][j]: area that closes the chain from i to j; through[i][j]: the third corner at its
  // edge
  std::vector<std::vector<double>> least(n, std::vector<double>(n, 0));
  std::vector<std::vector<std::size_t>> through(n, std::vector<std::size_t>(n, 0));
  for (std::size_t length = 2; length < n; ++length) {
    for (std::size_t i = 0; i + length < n; ++i) {
      const std::size_t j = i + length;
      least[i][j] = std::numeric_limits<double>::infinity();
      for (std::size_t k = i + 1; k < j; ++k) {
        const double area = 0.5 * (place(k) - place(i)).cross(place(j) - place(i)).norm();
        const double sum = least[i][k] + least[k][j] + area;
        if (sum >= least[i][j]) continue;
        least[i][j] = sum;
        through[i][j] = k;
      }
    }
  }
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, n - 1}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j - i < 2) continue;
    const std::size_t k = through[i][j];
    surface.corners.push_back({hole.points[i], hole.points[k], hole.points[j]});
    open.emplace_back(i, k);
    open.emplace_back(k, j);
  }
  return true;
}

}  // namespace langer
