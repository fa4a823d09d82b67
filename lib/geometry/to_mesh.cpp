// gmsh model -> Mesh. The order of a hexahedron's nodes follows from gmsh's reference coordinates of the element type,
// matched with ours; no table is transcribed.
#include <map>

#include <fmt/format.h>

#include "element/reference.hpp"
#include "geometry/session.hpp"

namespace langer {

std::array<int, 8> hexahedron_order(int type) {
  std::string name;
  int dim = 0, order = 0, n_nodes = 0, n_primary = 0;
  std::vector<double> xi;
  gmsh::model::mesh::getElementProperties(type, name, dim, order, n_nodes, xi, n_primary);
  std::array<int, 8> found;
  found.fill(-1);
  for (int a = 0; a < 8; ++a)
    for (int g = 0; g < n_nodes; ++g)
      if ((Vec3(xi[3 * g], xi[3 * g + 1], xi[3 * g + 2]) - Vec3(Hex8::corner[a][0], Hex8::corner[a][1], Hex8::corner[a][2]))
              .norm() < 1e-9)
        found[a] = g;
  return found;
}

Mesh to_mesh() {
  const int hexahedron = gmsh::model::mesh::getElementType("Hexahedron", 1);
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> elements, element_nodes;
  gmsh::model::mesh::getElements(types, elements, element_nodes, 3);
  if (types != std::vector<int>{hexahedron})
    throw Failure(Exit::config,
                  Error{{}, "geometry", fmt::format("gmsh made {} kinds of cells", types.size()), "hexahedra only", ""});

  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parametric;
  gmsh::model::mesh::getNodes(tags, coordinates, parametric);
  std::map<std::size_t, int> at;  // tag -> place in `tags`
  for (std::size_t i = 0; i < tags.size(); ++i) at[tags[i]] = static_cast<int>(i);

  Mesh mesh;
  std::map<std::size_t, int> number;  // only nodes that cells use
  const auto order = hexahedron_order(hexahedron);
  for (std::size_t e = 0; e < element_nodes[0].size(); e += 8)
    for (int a = 0; a < 8; ++a) {
      const std::size_t tag = element_nodes[0][e + static_cast<std::size_t>(order[a])];
      const auto [entry, is_new] = number.try_emplace(tag, mesh.n_nodes());
      if (is_new) mesh.X.emplace_back(coordinates.data() + 3 * at.at(tag));
      mesh.connectivity.push_back(entry->second);
    }
  return mesh;
}

}  // namespace langer
