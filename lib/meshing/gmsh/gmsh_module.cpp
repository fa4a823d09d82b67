// The module: the only code that calls gmsh.
#include <numbers>
#include <stdexcept>

#include "core/base/version.hpp"
#include "meshing/gmsh/gmsh_interface.hpp"
#include "meshing/gmsh/gmsh_session.hpp"

namespace langer::gmsh_module {

namespace {

// gmsh 4.8 throws texts, later ones exceptions
[[noreturn]] void throw_last_words() {
  std::string words;
  gmsh::logger::getLastError(words);
  throw std::runtime_error(words.empty() ? "no reason given" : words);
}

std::vector<Elements> elements(int dim, int entity = -1) {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, dim, entity);
  std::vector<Elements> all;
  for (std::size_t t = 0; t < types.size(); ++t) {
    Elements of{types[t], "", std::move(tags[t]), std::move(nodes[t])};
    int type_dim = 0, order = 0, n_nodes = 0, n_primary = 0;
    std::vector<double> xi;
    gmsh::model::mesh::getElementProperties(of.type, of.name, type_dim, order, n_nodes, xi,
                                            n_primary);
    all.push_back(std::move(of));
  }
  return all;
}

Model model() {
  Model m;
  m.cells = elements(3);
  std::vector<double> parametric;
  gmsh::model::mesh::getNodes(m.node_tags, m.X, parametric);
  gmsh::vectorpair pairs;
  gmsh::model::getPhysicalGroups(pairs);
  for (const auto& [dim, tag] : pairs) {
    Group group{dim, tag, "", {}, {}};
    gmsh::model::getPhysicalName(dim, tag, group.name);
    std::vector<int> entities;
    std::vector<double> X;
    gmsh::model::getEntitiesForPhysicalGroup(dim, tag, entities);
    if (dim < 2) gmsh::model::mesh::getNodesForPhysicalGroup(dim, tag, group.nodes, X);
    for (int entity : entities)
      if (dim >= 2)
        for (Elements& of : elements(dim, entity)) group.elements.push_back(std::move(of));
    m.groups.push_back(std::move(group));
  }
  return m;
}

Model read(const std::string& path) {
  const GmshSession session;
  try {
    gmsh::merge(path);
    return model();
  } catch (...) {
    throw_last_words();
  }
}

void name_group(int dim, int tag, const char* kind) {
  gmsh::model::setPhysicalName(dim, gmsh::model::addPhysicalGroup(dim, {tag}),
                               kind + std::to_string(tag));
}

Model solid(const std::string& path, const SolidOrder& order) {
  const GmshSession session;
  try {
    gmsh::vectorpair shapes, surfaces, volumes;
    if (order.facets) {
      gmsh::merge(path);
      constexpr double edge_angle =
          40 * std::numbers::pi / 180;  // faces meet where triangles turn by more
      gmsh::model::mesh::classifySurfaces(edge_angle, true, true);
      gmsh::model::mesh::createGeometry();
      gmsh::model::getEntities(surfaces, 2);
      std::vector<int> loop;
      for (const auto& [dim, tag] : surfaces) loop.push_back(tag);
      if (!loop.empty()) gmsh::model::geo::addVolume({gmsh::model::geo::addSurfaceLoop(loop)});
      gmsh::model::geo::synchronize();
      surfaces.clear();
    } else {
      gmsh::model::occ::importShapes(path, shapes);
      if (shapes.size() > 1)
        gmsh::model::occ::removeAllDuplicates();  // bodies that touch share their faces
      gmsh::model::occ::synchronize();
    }
    gmsh::model::getEntities(volumes, 3);
    if (volumes.empty()) return {false, {}, {}, {}, {}};
    if (volumes.size() > 1)
      for (const auto& [dim, tag] : volumes) name_group(3, tag, "body_");
    gmsh::model::getEntities(surfaces, 2);
    for (const auto& [dim, tag] : surfaces) name_group(2, tag, "face_");
    const double whole =
        order.hexahedra
            ? 2 * order.edge
            : order.edge;  // for hexahedra every tetrahedron is split into four, of half its size
    if (order.hexahedra) gmsh::option::setNumber("Mesh.SubdivisionAlgorithm", 2);
    if (order.straight)
      gmsh::option::setNumber("Mesh.SecondOrderLinear", 1);  // those of subdivision as well
    gmsh::option::setNumber("Mesh.MeshSizeMin", whole);
    gmsh::option::setNumber("Mesh.MeshSizeMax", whole);
    gmsh::model::mesh::generate(3);
    return model();
  } catch (...) {
    throw_last_words();
  }
}

}  // namespace

extern "C" __attribute__((visibility("default")))
const Functions langer_gmsh_module{version, read, solid};

}  // namespace langer::gmsh_module
