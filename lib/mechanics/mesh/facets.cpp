#include "mechanics/mesh/facets.hpp"

#include <algorithm>

#include "mechanics/mesh/reference.hpp"

namespace langer {

std::vector<int> facet_nodes(const Mesh& mesh, const Facet& facet) {
  const auto cell = mesh.cell(facet.cell);
  std::vector<int> nodes;
  for (int a : mesh.cell().facet[facet.local]) nodes.push_back(cell[a]);
  return nodes;
}

std::array<int, 4> facet_key(const Mesh& mesh, const Facet& facet) {
  const auto cell = mesh.cell(facet.cell);
  const auto& local = mesh.cell().facet[facet.local];
  std::array<int, 4> key{-1, -1, -1, -1};
  for (std::size_t k = 0; k < static_cast<std::size_t>(mesh.cell().facet_corners); ++k)
    key[k] = cell[local[k]];
  std::sort(key.begin(), key.end());
  return key;
}

std::vector<std::array<int, 4>> facet_quads(const Mesh& mesh, const Facet& facet) {
  const std::vector<int> n = facet_nodes(mesh, facet);
  if (!mesh.cell().second_order()) return {{n[0], n[1], n[2], n[3]}};
  std::vector<std::array<int, 4>> quads;
  const int sides = mesh.cell().facet_corners;
  for (int k = 0; k < sides; ++k)
    quads.push_back({n[k], n[sides + k], n[2 * sides], n[sides + (k + sides - 1) % sides]});
  return quads;
}

}  // namespace langer
