#include "mesh/raise.hpp"

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <map>

#include "mesh/reference.hpp"

namespace langer {

namespace {

// weights(xi) of the corners of a cell of first order; a new node lies between the corners that have some, in equal parts
Mesh raise(const std::vector<Vec3>& X, const std::vector<int>& connectivity, std::size_t n_corners, CellType to,
           const std::function<VecX(const Vec3&)>& weights) {
  std::vector<std::vector<std::size_t>> between;  // by node of the new cell: those corners
  for (const Vec3& xi : reference(nodes_per_cell(to)).node) {
    const VecX N = weights(xi);
    between.emplace_back();
    for (std::size_t b = 0; b < n_corners; ++b)
      if (N[static_cast<Eigen::Index>(b)] > 1e-9) between.back().push_back(b);
  }
  Mesh out;
  out.type = to, out.X = X;
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

// Local nodes of the hexahedra between the nodes of a cell, eight for each.
std::vector<std::size_t> hexahedra_in(CellType type) {
  const ReferenceCell& cell = reference(nodes_per_cell(type));
  std::vector<std::size_t> nodes;
  const auto add = [&](const Vec3& xi) {
    const auto found = std::find_if(cell.node.begin(), cell.node.end(), [&](const Vec3& n) { return (n - xi).norm() < 1e-9; });
    nodes.push_back(static_cast<std::size_t>(found - cell.node.begin()));
  };
  if (type == CellType::tet15) {
    // one at each corner, up to the middles of the edges, facets and cell; its neighbours in right-handed order
    constexpr int around[4][3] = {{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}};
    const auto middle = [&](std::initializer_list<int> corners) {
      Vec3 x = Vec3::Zero();
      for (int c : corners) x += cell.node[static_cast<std::size_t>(c)] / static_cast<double>(corners.size());
      add(x);
    };
    for (int i = 0; i < 4; ++i) {
      const auto [j, k, l] = around[i];
      middle({i}), middle({i, j}), middle({i, j, k}), middle({i, k});
      middle({i, l}), middle({i, j, l}), middle({0, 1, 2, 3}), middle({i, k, l});
    }
    return nodes;
  }
  const auto& corners = reference(8).node;
  for (const Vec3& octant : corners)
    for (const Vec3& corner : corners) add((octant + corner) / 2);
  return nodes;
}

}  // namespace

Mesh raised(const Mesh& mesh, CellType to) {
  if (to == mesh.type) return mesh;
  return raise(mesh.X, mesh.connectivity, 8, to, reference(8).shape);
}

Mesh raised_tetrahedra(const std::vector<Vec3>& X, const std::vector<int>& corners) {
  return raise(X, corners, 4, CellType::tet15,
               [](const Vec3& xi) -> VecX { return Eigen::Vector4d(1 - xi.sum(), xi[0], xi[1], xi[2]); });
}

Mesh between_nodes(const Mesh& mesh) {
  Mesh out;
  out.X = mesh.X;
  if (mesh.type == CellType::hex8) {
    out.connectivity = mesh.connectivity;
    return out;
  }
  const std::vector<std::size_t> local = hexahedra_in(mesh.type);
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (std::size_t a : local) out.connectivity.push_back(mesh.cell(e)[a]);
  return out;
}

}  // namespace langer
