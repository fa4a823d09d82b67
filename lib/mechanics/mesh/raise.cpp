#include "mechanics/mesh/raise.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <span>

#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/mesh/select.hpp"

namespace langer {

namespace {

std::vector<int> corners_around(const ReferenceCell& cell, std::size_t node) {
  const VecX L = cell.corner_shape(cell.node[node]);
  std::vector<int> corners;
  for (Eigen::Index b = 0; b < L.size(); ++b)
    if (L[b] > 1e-9) corners.push_back(static_cast<int>(b));
  return corners;
}

// Shape functions of the cell whose nodes are the corners and the middles of edges: of a hexahedron
// Shape functions of corners and middles of edges: serendipity functions of a hexahedron, quadratic
// ones of a tetrahedron.
VecX shape_with_edges(const ReferenceCell& cell, const Vec3& xi) {
  const VecX L = cell.corner_shape(xi);
  VecX N = VecX::Zero(L.size() + static_cast<Eigen::Index>(cell.edge.size()));
  N.head(L.size()) = L;
  for (Eigen::Index n = L.size(); n < N.size(); ++n) {
    const std::vector<int> ends = corners_around(cell, static_cast<std::size_t>(n));
    const double a = L[ends[0]];
    const double b = L[ends[1]];
    if (!cell.hexahedron())
      N[n] = 4 * a * b;
    else if (a + b > 0)
      N[n] = 4 * a * b / (a + b);
    for (int end : ends) N[end] -= 0.5 * N[n];
  }
  return N;
}

// given: nodes of each cell that are there; place_of(local, nodes): of the new node `local`
template <class PlaceOf>
Mesh raised(const std::vector<Vec3>& X, const std::vector<int>& connectivity,
            const ReferenceCell& cell, std::size_t given, const PlaceOf& place_of) {
  std::vector<std::vector<int>> between;  // by node of the new cell
  for (std::size_t a = 0; a < cell.node.size(); ++a) between.push_back(corners_around(cell, a));
  Mesh out;
  out.type = cell.type;
  out.X = X;
  std::map<std::vector<int>, int> middle_of;  // corners -> node between them
  for (std::size_t first = 0; first < connectivity.size(); first += given) {
    const std::span<const int> nodes(connectivity.data() + first, given);
    out.connectivity.insert(out.connectivity.end(), nodes.begin(), nodes.end());
    for (std::size_t a = given; a < between.size(); ++a) {
      std::vector<int> corners;
      for (int b : between[a]) corners.push_back(nodes[static_cast<std::size_t>(b)]);
      std::sort(corners.begin(), corners.end());
      const auto [entry, is_new] = middle_of.try_emplace(corners, out.n_nodes());
      if (is_new) out.X.push_back(place_of(a, corners, nodes));
      out.connectivity.push_back(entry->second);
    }
  }
  return out;
}

}  // namespace

// a new node lies between those corners in equal parts
Mesh raised(const std::vector<Vec3>& X, const std::vector<int>& connectivity, CellType to) {
  const ReferenceCell& cell = reference(to);
  const auto middle = [&](std::size_t, const std::vector<int>& corners,
                          std::span<const int>) -> Vec3 {
    Vec3 x = Vec3::Zero();
    for (int b : corners) x += X[b];
    return x / static_cast<double>(corners.size());
  };
  return raised(X, connectivity, cell, static_cast<std::size_t>(cell.n_corners), middle);
}

Mesh raised_with_edges(const std::vector<Vec3>& X, const std::vector<int>& connectivity,
                       CellType to) {
  const ReferenceCell& cell = reference(to);
  std::vector<VecX> share;
  for (const Vec3& xi : cell.node) share.push_back(shape_with_edges(cell, xi));
  const auto middle = [&](std::size_t a, const std::vector<int>&, std::span<const int> nodes) {
    Vec3 x = Vec3::Zero();
    for (std::size_t b = 0; b < nodes.size(); ++b)
      x += share[a][static_cast<Eigen::Index>(b)] * X[nodes[b]];
    return x;
  };
  return raised(X, connectivity, cell, static_cast<std::size_t>(cell.n_corners) + cell.edge.size(),
                middle);
}

void add_new_middles(Mesh& mesh, int first_new) {
  std::vector<std::vector<int>> outer;  // nodes of the surface's facets
  for (const Facet& facet : boundary(mesh)) outer.push_back(facet_nodes(mesh, facet));
  const auto n_corners = static_cast<std::size_t>(mesh.cell().facet_corners);
  for (auto& [name, nodes] : mesh.node_sets) {
    std::vector<char> in(mesh.X.size());
    for (int n : nodes) in[n] = 1;
    const auto add = [&](std::span<const int> part) {
      if (std::any_of(part.begin(), part.end(), [&](int n) { return n < first_new && !in[n]; }))
        return;
      for (int n : part) in[n] = 1;
    };
    for (const std::vector<int>& of : outer) {
      for (std::size_t k = 0; k < n_corners; ++k)
        add(std::array{of[k], of[(k + 1) % n_corners], of[n_corners + k]});
      add(of);
    }
    for (int e = 0; e < mesh.n_cells(); ++e) add(mesh.cell(e));
    nodes.clear();
    for (int n = 0; n < mesh.n_nodes(); ++n)
      if (in[n]) nodes.push_back(n);
  }
}

Mesh raised(const Mesh& mesh, CellType to) {
  if (to == mesh.type) return mesh;
  return raised(mesh.X, mesh.connectivity, to);
}

Mesh between_nodes(const Mesh& mesh) {
  Mesh out;
  out.X = mesh.X;
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int a : mesh.cell().parts)
      out.connectivity.push_back(mesh.cell(e)[static_cast<std::size_t>(a)]);
  return out;
}

}  // namespace langer
