// The module: the only code that calls gmsh.
#include <numbers>
#include <stdexcept>
#include <utility>

#include "core/base/text.hpp"
#include "core/base/version.hpp"
#include "meshing/gmsh/gmsh_interface.hpp"
#include "meshing/gmsh/gmsh_session.hpp"
#include "meshing/msh_types.hpp"

namespace langer::gmsh_module {

namespace {

// gmsh 4.8 throws texts, later ones exceptions
[[noreturn]] void throw_last_words() {
  std::string words;
  gmsh::logger::getLastError(words);
  throw std::runtime_error(text_or(words, "no reason given"));
}

std::vector<MshElements> elements(int dim, int entity = -1) {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags;
  std::vector<std::vector<std::size_t>> nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, dim, entity);
  std::vector<MshElements> all;
  for (std::size_t t = 0; t < types.size(); ++t) {
    MshElements of{types[t], "", std::move(tags[t]), std::move(nodes[t]), {}};
    int type_dim = 0;
    int order = 0;
    int n_nodes = 0;
    int n_primary = 0;
    std::vector<double> xi;
    gmsh::model::mesh::getElementProperties(of.type, of.name, type_dim, order, n_nodes, xi,
                                            n_primary);
    all.push_back(std::move(of));
  }
  return all;
}

// Nodes, cells and the groups of surfaces and volumes, which are all that name_group makes.
MshModel current_model() {
  MshModel model;
  model.cells = elements(3);
  std::vector<double> parametric;
  gmsh::model::mesh::getNodes(model.node_tags, model.X, parametric);
  gmsh::vectorpair pairs;
  gmsh::model::getPhysicalGroups(pairs);
  for (const auto& [dim, tag] : pairs) {
    MshGroup group{dim, tag, "", {}, {}};
    gmsh::model::getPhysicalName(dim, tag, group.name);
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(dim, tag, entities);
    for (const int entity : entities)
      for (MshElements& of : elements(dim, entity)) group.elements.push_back(std::move(of));
    model.groups.push_back(std::move(group));
  }
  return model;
}

void name_group(int dim, int tag, const char* kind) {
  gmsh::model::setPhysicalName(dim, gmsh::model::addPhysicalGroup(dim, {tag}),
                               kind + std::to_string(tag));
}

// The triangles as faces, which meet where triangles turn by more than 40 degrees, around a volume.
void make_volume(const Surface& surface) {
  constexpr int face = 1;
  gmsh::model::addDiscreteEntity(2, face);
  std::vector<std::size_t> points;
  for (std::size_t i = 1; i <= surface.X.size() / 3; ++i) points.push_back(i);
  gmsh::model::mesh::addNodes(2, face, points, surface.X);
  gmsh::model::mesh::addElementsByType(face, msh_type::triangle, {}, surface.corners);
  constexpr double edge_angle = 40 * std::numbers::pi / 180;
  gmsh::model::mesh::classifySurfaces(edge_angle, true, true);
  gmsh::model::mesh::createGeometry();
  gmsh::vectorpair faces;
  gmsh::model::getEntities(faces, 2);
  std::vector<int> loop;
  for (const auto& [dim, tag] : faces) loop.push_back(tag);
  if (!loop.empty()) gmsh::model::geo::addVolume({gmsh::model::geo::addSurfaceLoop(loop)});
  gmsh::model::geo::synchronize();
}

// The solids of a STEP file. Solids that touch share their faces.
void import_step(const std::string& path) {
  gmsh::vectorpair shapes;
  gmsh::model::occ::importShapes(path, shapes, true, "step");
  if (shapes.size() > 1) gmsh::model::occ::removeAllDuplicates();
  gmsh::model::occ::synchronize();
}

// Meshes the volumes of the current model. Faces are groups, and volumes where there are several.
MshModel mesh_volumes(const SolidOrder& order) {
  gmsh::vectorpair volumes;
  gmsh::model::getEntities(volumes, 3);
  if (volumes.empty()) {
    MshModel nothing;
    nothing.has_volumes = false;
    return nothing;
  }
  if (volumes.size() > 1)
    for (const auto& [dim, tag] : volumes) name_group(3, tag, "body_");
  gmsh::vectorpair surfaces;
  gmsh::model::getEntities(surfaces, 2);
  for (const auto& [dim, tag] : surfaces) name_group(2, tag, "face_");

  // For hexahedra every tetrahedron is split into four, of half its size.
  double edge = order.edge;
  if (order.hexahedra) edge = 2 * order.edge;
  if (order.hexahedra) gmsh::option::setNumber("Mesh.SubdivisionAlgorithm", 2);
  // Those of subdivision as well stay on straight edges.
  if (order.straight) gmsh::option::setNumber("Mesh.SecondOrderLinear", 1);
  gmsh::option::setNumber("Mesh.MeshSizeMin", edge);
  gmsh::option::setNumber("Mesh.MeshSizeMax", edge);
  gmsh::model::mesh::generate(3);
  return current_model();
}

template <class MakeShape>
MshModel mesh_shape(const SolidOrder& order, const MakeShape& make_shape) {
  const GmshSession session;
  try {
    make_shape();
    return mesh_volumes(order);
  } catch (...) {
    throw_last_words();
  }
}

MshModel mesh_surface(const Surface& surface, const SolidOrder& order) {
  return mesh_shape(order, [&] { make_volume(surface); });
}

MshModel mesh_step(const std::string& path, const SolidOrder& order) {
  return mesh_shape(order, [&] { import_step(path); });
}

}  // namespace

extern "C" __attribute__((visibility("default")))
const Functions langer_gmsh_module{version, mesh_surface, mesh_step};

}  // namespace langer::gmsh_module
