#include "mesh/raise.hpp"

#include <algorithm>
#include <map>

#include "element/reference.hpp"

namespace langer {

Mesh raised(const Mesh& mesh, CellType to) {
  if (to == mesh.type) return mesh;
  const ReferenceCell &from = reference(nodes_per_cell(mesh.type)), &cell = reference(nodes_per_cell(to));
  Mesh out;
  out.type = to, out.X = mesh.X;
  std::map<std::vector<int>, int> middle_of;  // corners -> node between them
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int a = 0; a < cell.n_nodes; ++a) {
      // a node lies between the corners whose shape functions do not vanish there, in equal parts
      const VecX N = from.shape(cell.node[a]);
      std::vector<int> corners;
      for (int b = 0; b < from.n_nodes; ++b)
        if (N[b] > 1e-9) corners.push_back(mesh.cell(e)[b]);
      std::sort(corners.begin(), corners.end());
      if (corners.size() == 1) {
        out.connectivity.push_back(corners[0]);
        continue;
      }
      const auto [entry, is_new] = middle_of.try_emplace(corners, out.n_nodes());
      if (is_new) {
        Vec3 x = Vec3::Zero();
        for (int b : corners) x += mesh.X[b];
        out.X.push_back(x / static_cast<double>(corners.size()));
      }
      out.connectivity.push_back(entry->second);
    }
  return out;
}

Mesh between_nodes(const Mesh& mesh) {
  Mesh out;
  out.X = mesh.X;
  if (mesh.type == CellType::hex8) {
    out.connectivity = mesh.connectivity;
    return out;
  }
  const ReferenceCell &linear = reference(8), &cell = reference(27);
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (const Vec3& octant : linear.node)
      for (const Vec3& corner : linear.node) {
        const Vec3 xi = (octant + corner) / 2;
        const auto found = std::find(cell.node.begin(), cell.node.end(), xi);
        out.connectivity.push_back(mesh.cell(e)[static_cast<std::size_t>(found - cell.node.begin())]);
      }
  return out;
}

}  // namespace langer
