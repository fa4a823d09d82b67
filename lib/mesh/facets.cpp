#include "mesh/facets.hpp"

#include <algorithm>

#include "element/reference.hpp"

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
  std::array<int, 4> key{cell[local[0]], cell[local[1]], cell[local[2]], cell[local[3]]};
  std::sort(key.begin(), key.end());
  return key;
}

std::vector<std::array<int, 4>> facet_quads(const Mesh& mesh, const Facet& facet) {
  const std::vector<int> n = facet_nodes(mesh, facet);
  if (n.size() == 4) return {{n[0], n[1], n[2], n[3]}};
  std::vector<std::array<int, 4>> quads;
  for (int k = 0; k < 4; ++k) quads.push_back({n[k], n[4 + k], n[8], n[4 + (k + 3) % 4]});
  return quads;
}

}  // namespace langer
