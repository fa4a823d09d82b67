#include "mesh/raise.hpp"

#include <algorithm>
#include <map>

#include "mesh/reference.hpp"

namespace langer {

// a new node lies between the corners whose shape functions are not 0 there, in equal parts
Mesh raised(const std::vector<Vec3>& X, const std::vector<int>& connectivity, CellType to) {
  const ReferenceCell& cell = reference(to);
  const auto n_corners = static_cast<std::size_t>(cell.n_corners);
  std::vector<std::vector<std::size_t>> between;  // by node of the new cell: those corners
  for (const Vec3& xi : cell.node) {
    const VecX N = cell.corner_shape(xi);
    between.emplace_back();
    for (std::size_t b = 0; b < n_corners; ++b)
      if (N[static_cast<Eigen::Index>(b)] > 1e-9) between.back().push_back(b);
  }
  Mesh out;
  out.type = cell.type, out.X = X;
  std::map<std::vector<int>, int> middle_of;  // corners -> node between them
  for (std::size_t first = 0; first < connectivity.size(); first += n_corners)
    for (const auto& local : between) {
      std::vector<int> corners;
      for (std::size_t b : local) corners.push_back(connectivity[first + b]);
      std::sort(corners.begin(), corners.end());
      if (corners.size() == 1) {
        out.connectivity.push_back(corners[0]);
        continue;
      }
      const auto [entry, is_new] = middle_of.try_emplace(corners, out.n_nodes());
      if (is_new) {
        Vec3 x = Vec3::Zero();
        for (int b : corners) x += X[b];
        out.X.push_back(x / static_cast<double>(corners.size()));
      }
      out.connectivity.push_back(entry->second);
    }
  return out;
}

Mesh raised(const Mesh& mesh, CellType to) { return to == mesh.type ? mesh : raised(mesh.X, mesh.connectivity, to); }

Mesh between_nodes(const Mesh& mesh) {
  Mesh out;
  out.X = mesh.X;
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int a : mesh.cell().parts) out.connectivity.push_back(mesh.cell(e)[static_cast<std::size_t>(a)]);
  return out;
}

}  // namespace langer
