#include "mesh/raise.hpp"

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <map>

#include "element/reference.hpp"

namespace langer {

namespace {

// weights(xi) of the corners of a cell of first order; a new node lies between the corners that have some, in equal parts
Mesh raise(const std::vector<Vec3>& X, const std::vector<int>& connectivity, std::size_t n_corners, CellType to,
           const std::function<VecX(const Vec3&)>& weights) {
  const ReferenceCell& cell = reference(nodes_per_cell(to));
  Mesh out;
  out.type = to, out.X = X;
  std::map<std::vector<int>, int> middle_of;  // corners -> node between them
  for (std::size_t first = 0; first < connectivity.size(); first += n_corners)
    for (int a = 0; a < cell.n_nodes; ++a) {
      const VecX N = weights(cell.node[a]);
      std::vector<int> corners;
      for (std::size_t b = 0; b < n_corners; ++b)
        if (N[static_cast<Eigen::Index>(b)] > 1e-9) corners.push_back(connectivity[first + b]);
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

}  // namespace

Mesh raised(const Mesh& mesh, CellType to) {
  if (to == mesh.type) return mesh;
  return raise(mesh.X, mesh.connectivity, 8, to, reference(8).shape);
}

Mesh raised_tetrahedra(const std::vector<Vec3>& X, const std::vector<int>& corners) {
  return raise(X, corners, 4, CellType::tet15, [](const Vec3& xi) -> VecX { return Eigen::Vector4d(1 - xi.sum(), xi[0], xi[1], xi[2]); });
}

Mesh between_nodes(const Mesh& mesh) {
  Mesh out;
  out.X = mesh.X;
  if (mesh.type == CellType::hex8) {
    out.connectivity = mesh.connectivity;
    return out;
  }
  const ReferenceCell &linear = reference(8), &cell = reference(nodes_per_cell(mesh.type));
  if (mesh.type == CellType::tet15) {
    // at each corner one hexahedron, up to the middles of the edges, facets and cell; its neighbours in right-handed order
    constexpr int around[4][3] = {{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}};
    const auto between = [&](std::initializer_list<int> corners) {
      Vec3 x = Vec3::Zero();
      for (int c : corners) x += cell.node[static_cast<std::size_t>(c)] / static_cast<double>(corners.size());
      const auto found = std::find_if(cell.node.begin(), cell.node.end(), [&](const Vec3& n) { return (n - x).norm() < 1e-9; });
      return static_cast<std::size_t>(found - cell.node.begin());
    };
    for (int e = 0; e < mesh.n_cells(); ++e)
      for (int i = 0; i < 4; ++i) {
        const auto [j, k, l] = around[i];
        for (std::size_t a : {between({i}), between({i, j}), between({i, j, k}), between({i, k}), between({i, l}), between({i, j, l}),
                              between({0, 1, 2, 3}), between({i, k, l})})
          out.connectivity.push_back(mesh.cell(e)[a]);
      }
    return out;
  }
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
