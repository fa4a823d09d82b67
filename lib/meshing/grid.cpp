#include "meshing/grid.hpp"

namespace langer {

Mesh extruded(const Plan& plan, const std::vector<double>& heights) {
  Mesh mesh;
  const int per_layer = static_cast<int>(plan.points.size());
  mesh.X.reserve(plan.points.size() * heights.size());
  for (double y : heights)
    for (const auto& [x, z] : plan.points) mesh.X.emplace_back(x, y, z);
  mesh.connectivity.reserve(8 * plan.cells.size() * heights.size());
  for (int k = 0; k + 1 < static_cast<int>(heights.size()); ++k)
    for (const auto& [a, b, c, d] : plan.cells) {
      const int low = k * per_layer;
      const int high = low + per_layer;
      for (int node : {low + a, low + b, high + b, high + a, low + d, low + c, high + c, high + d})
        mesh.connectivity.push_back(node);
    }
  return mesh;
}

Mesh hexahedra_between(const GridLines& lines) {
  Plan plan;
  for (double z : lines[2])
    for (double x : lines[0]) plan.points.push_back({x, z});
  const int nx = static_cast<int>(lines[0].size());
  const int nz = static_cast<int>(lines[2].size());
  for (int k = 0; k + 1 < nz; ++k)
    for (int i = 0; i + 1 < nx; ++i) {
      const int at = k * nx + i;
      plan.cells.push_back({at, at + 1, at + nx + 1, at + nx});
    }
  return extruded(plan, lines[1]);
}

}  // namespace langer
