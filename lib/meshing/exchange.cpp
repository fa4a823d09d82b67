#include "meshing/exchange.hpp"

#include <algorithm>

#include "mechanics/mesh/facets.hpp"

namespace langer {

std::vector<int> nodes_of(const Mesh& mesh, const std::vector<Facet>& facets) {
  std::vector<int> nodes;
  for (const Facet& facet : facets)
    for (int n : facet_nodes(mesh, facet)) nodes.push_back(n);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

void name_facets(Mesh& mesh, const std::string& name, const std::vector<Facet>& facets) {
  mesh.facet_sets[name] = facets;
  mesh.node_sets[name] = nodes_of(mesh, facets);
}

}  // namespace langer
