#include "mesh/facets.hpp"

#include <algorithm>

#include "mesh/reference.hpp"

namespace langer {

std::vector<int> facet_nodes(const Mesh& mesh, const Facet& facet) {
  const auto cell = mesh.cell(facet.cell);
  std::vector<int> nodes;
  for (int a : reference(nodes_per_cell(mesh.type)).facet[facet.local]) nodes.push_back(cell[a]);
  return nodes;
}

std::array<int, 4> facet_key(const Mesh& mesh, const Facet& facet) {
  const auto cell = mesh.cell(facet.cell);
  const auto& local = reference(nodes_per_cell(mesh.type)).facet[facet.local];
  std::array<int, 4> key{-1, -1, -1, -1};
  for (std::size_t k = 0; k < (mesh.type == CellType::tet15 ? 3 : 4); ++k) key[k] = cell[local[k]];
  std::sort(key.begin(), key.end());
  return key;
}

std::vector<std::array<int, 4>> facet_quads(const Mesh& mesh, const Facet& facet) {
  const std::vector<int> n = facet_nodes(mesh, facet);
  if (n.size() == 4) return {{n[0], n[1], n[2], n[3]}};
  std::vector<std::array<int, 4>> quads;
  const int sides = n.size() == 7 ? 3 : 4;
  for (int k = 0; k < sides; ++k) quads.push_back({n[k], n[sides + k], n[2 * sides], n[sides + (k + sides - 1) % sides]});
  return quads;
}

}  // namespace langer
