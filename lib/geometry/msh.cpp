// Gmsh meshes through gmsh: physical groups are bodies, facet sets and node sets.
#include <algorithm>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/exchange.hpp"
#include "geometry/session.hpp"
#include "mesh/facets.hpp"
#include "mesh/raise.hpp"

namespace langer {

namespace {

struct Group {
  int dim = 0, tag = 0;
  std::string name;
  std::vector<int> entities;
};

std::vector<Group> groups() {
  gmsh::vectorpair pairs;
  gmsh::model::getPhysicalGroups(pairs);
  std::vector<Group> all;
  for (const auto& [dim, tag] : pairs) {
    Group g{dim, tag, "", {}};
    gmsh::model::getPhysicalName(dim, tag, g.name);
    constexpr const char* kinds[] = {"points", "curves", "surfaces", "volume"};
    if (g.name.empty()) g.name = fmt::format("{}_{}", kinds[dim], tag);
    gmsh::model::getEntitiesForPhysicalGroup(dim, tag, g.entities);
    all.push_back(g);
  }
  // of one name what has more to say comes first: a node set of its own replaces the nodes of facets
  std::stable_sort(all.begin(), all.end(), [](const Group& a, const Group& b) { return a.dim > b.dim; });
  return all;
}

std::string element_name(int type) {
  std::string name;
  int dim = 0, order = 0, n_nodes = 0, n_primary = 0;
  std::vector<double> xi;
  gmsh::model::mesh::getElementProperties(type, name, dim, order, n_nodes, xi, n_primary);
  return name;
}

class MshReader {
 public:
  MshReader(const std::string& path, std::vector<std::string>& notes) : path_(path), notes_(notes) {}

  Mesh read() {
    const int hexahedron = gmsh::model::mesh::getElementType("Hexahedron", 1), tetrahedron = gmsh::model::mesh::getElementType("Tetrahedron", 1);
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> elements, nodes;
    gmsh::model::mesh::getElements(types, elements, nodes, 3);
    const char* expected = "8-node hexahedra only, or 4-node tetrahedra only";
    for (int type : types)
      if (type != hexahedron && type != tetrahedron) refuse("found cells of the kind " + element_name(type), expected);
    if (types.size() != 1) refuse(types.empty() ? "no cells" : "hexahedra beside tetrahedra", expected);
    type_ = types[0];
    const bool split = type_ == tetrahedron;

    std::vector<std::size_t> tags;
    std::vector<double> X, parametric;
    gmsh::model::mesh::getNodes(tags, X, parametric);
    std::map<std::size_t, std::size_t> place;  // by tag, ascending
    for (std::size_t i = 0; i < tags.size(); ++i) place[tags[i]] = i;
    const std::set<std::size_t> used(nodes[0].begin(), nodes[0].end());
    for (std::size_t tag : used) {
      const auto found = place.find(tag);
      if (found == place.end()) refuse(fmt::format("a cell has the node {}, which is not there", tag));
      node_at_[tag] = mesh_.n_nodes();
      mesh_.X.emplace_back(X.data() + 3 * found->second);
      if (!mesh_.X.back().allFinite()) refuse(fmt::format("the position of the node {} is not finite", tag));
    }
    std::vector<std::pair<std::size_t, std::size_t>> order;  // tag, place
    for (std::size_t e = 0; e < elements[0].size(); ++e) order.emplace_back(elements[0][e], e);
    std::sort(order.begin(), order.end());
    std::vector<int> corner{0, 1, 2, 3};
    if (!split) {
      const auto of_hexahedron = hexahedron_order(hexahedron);
      corner.assign(of_hexahedron.begin(), of_hexahedron.end());
    }
    std::vector<int> corners;
    for (const auto& [tag, e] : order) {
      cell_at_[tag] = static_cast<int>(corners.size() / corner.size());
      for (int a : corner) corners.push_back(node_at_.at(nodes[0][corner.size() * e + static_cast<std::size_t>(a)]));
    }
    if (split)
      mesh_ = raised_tetrahedra(mesh_.X, corners);
    else
      mesh_.connectivity = corners;
    mesh_.body.assign(static_cast<std::size_t>(mesh_.n_cells()), -1);
    for (const Group& group : groups()) {
      if (group.dim == 3) add_body(group);
      if (group.dim == 2) add_facets(group);
      if (group.dim < 2) add_nodes(group);
    }
    if (std::count(mesh_.body.begin(), mesh_.body.end(), -1) > 0) {
      for (int& body : mesh_.body)
        if (body < 0) body = static_cast<int>(mesh_.bodies.size());
      mesh_.bodies.push_back("");
    }
    return mesh_;
  }

  [[noreturn]] void refuse(const std::string& found, const std::string& expected = "") const {
    throw Failure(Exit::input, Error{{path_}, "", found, expected, ""});
  }

 private:
  std::string path_;
  std::vector<std::string>& notes_;
  int type_ = 0;  // gmsh's, of the cells
  Mesh mesh_;
  std::map<std::size_t, int> node_at_, cell_at_;
  std::map<std::array<int, 4>, Facet> facet_at_;

  void add_body(const Group& group) {
    const int body = static_cast<int>(mesh_.bodies.size());
    mesh_.bodies.push_back(group.name);
    for (int entity : group.entities) {
      std::vector<std::size_t> tags, nodes;
      gmsh::model::mesh::getElementsByType(type_, tags, nodes, entity);
      for (std::size_t tag : tags) {
        int& of = mesh_.body[cell_at_.at(tag)];
        if (of >= 0) refuse(fmt::format("cell {} belongs to \"{}\" and to \"{}\"", tag, mesh_.bodies[of], group.name), "one physical volume for each cell");
        of = body;
      }
    }
  }

  void add_facets(const Group& group) {
    if (facet_at_.empty())
      for (int e = mesh_.n_cells() - 1; e >= 0; --e)  // of two cells that share it the first
        for (int f = 0; f < n_facets(mesh_.type); ++f) facet_at_[facet_key(mesh_, {e, f})] = {e, f};
    std::vector<Facet> facets;
    for (int entity : group.entities) {
      std::vector<int> types;
      std::vector<std::vector<std::size_t>> elements, nodes;
      gmsh::model::mesh::getElements(types, elements, nodes, 2, entity);
      for (std::size_t t = 0; t < types.size(); ++t) {
        const bool triangles = mesh_.type == CellType::tet15;
        if (types[t] != gmsh::model::mesh::getElementType(triangles ? "Triangle" : "Quadrangle", 1))
          refuse(fmt::format("the surface \"{}\" has faces of the kind {}", group.name, element_name(types[t])),
                 triangles ? "triangles, the facets of tetrahedra" : "quadrangles, the facets of hexahedra");
        const std::size_t n_corners = triangles ? 3 : 4;
        for (std::size_t i = 0; i < nodes[t].size(); i += n_corners) {
          std::array<int, 4> key{-1, -1, -1, -1};
          for (std::size_t k = 0; k < n_corners; ++k) {
            const auto node = node_at_.find(nodes[t][i + k]);
            key[k] = node == node_at_.end() ? -1 : node->second;
          }
          std::sort(key.begin(), key.end());
          const auto facet = facet_at_.find(key);
          if (facet == facet_at_.end()) refuse(fmt::format("the surface \"{}\" has a face that is no facet of a cell", group.name));
          facets.push_back(facet->second);
        }
      }
    }
    std::sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) { return std::pair(a.cell, a.local) < std::pair(b.cell, b.local); });
    if (facets.empty())
      notes_.push_back("left out, as it has no faces: surface " + group.name);
    else
      name_facets(mesh_, group.name, facets);
  }

  void add_nodes(const Group& group) {
    std::vector<std::size_t> tags;
    std::vector<double> X;
    gmsh::model::mesh::getNodesForPhysicalGroup(group.dim, group.tag, tags, X);
    std::set<int> nodes;
    for (std::size_t tag : tags)
      if (const auto node = node_at_.find(tag); node != node_at_.end()) nodes.insert(node->second);
    if (nodes.empty())
      notes_.push_back("left out, as no cell has its nodes: " + group.name);
    else
      mesh_.node_sets[group.name] = {nodes.begin(), nodes.end()};
  }
};

}  // namespace

Mesh read_msh(const std::string& path, std::vector<std::string>& notes) {
  const GmshSession session;
  MshReader reader(path, notes);
  try {
    gmsh::merge(path);
  } catch (...) {  // gmsh 4.8 throws texts, later ones exceptions
    std::string words;
    gmsh::logger::getLastError(words);
    reader.refuse("gmsh cannot read it: " + (words.empty() ? "no reason given" : words));
  }
  return reader.read();
}

Mesh read_solid(const std::string& path, bool facets, double edge, CellType cells, std::vector<std::string>& notes) {
  const GmshSession session;
  MshReader reader(path, notes);
  try {
    const NoTraps in_gmsh;  // it divides zero by zero where it lays out surfaces of triangles
    gmsh::vectorpair shapes, surfaces, volumes;
    if (facets) {
      gmsh::merge(path);
      constexpr double edge_angle = 40 * std::numbers::pi / 180;  // faces meet where triangles turn by more
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
      if (shapes.size() > 1) gmsh::model::occ::removeAllDuplicates();  // bodies that touch share their faces
      gmsh::model::occ::synchronize();
    }
    gmsh::model::getEntities(volumes, 3);
    for (const auto& [dim, tag] : volumes)
      if (volumes.size() > 1) gmsh::model::setPhysicalName(3, gmsh::model::addPhysicalGroup(3, {tag}), fmt::format("body_{}", tag));
    gmsh::model::getEntities(surfaces, 2);
    for (const auto& [dim, tag] : surfaces) gmsh::model::setPhysicalName(2, gmsh::model::addPhysicalGroup(2, {tag}), fmt::format("face_{}", tag));
    // for hexahedra every tetrahedron is split into four, of half its size
    const double whole = cells == CellType::tet15 ? edge : 2 * edge;
    if (cells != CellType::tet15) gmsh::option::setNumber("Mesh.SubdivisionAlgorithm", 2);
    gmsh::option::setNumber("Mesh.MeshSizeMin", whole);
    gmsh::option::setNumber("Mesh.MeshSizeMax", whole);
    if (volumes.empty()) reader.refuse("no solid body", facets ? "triangles that enclose one" : "a STEP file with a solid");
    gmsh::model::mesh::generate(3);
  } catch (const Failure&) {
    throw;
  } catch (...) {
    std::string words;
    gmsh::logger::getLastError(words);
    reader.refuse("gmsh cannot mesh it: " + (words.empty() ? "no reason given" : words));
  }
  return reader.read();
}

void write_msh(const std::string& path, const Mesh& mesh) {
  const GmshSession session;
  // one volume for each body, all nodes with the first
  std::vector<std::size_t> tags;
  std::vector<double> X;
  for (int n = 0; n < mesh.n_nodes(); ++n) {
    tags.push_back(static_cast<std::size_t>(n) + 1);
    X.insert(X.end(), mesh.X[n].data(), mesh.X[n].data() + 3);
  }
  const int hexahedron = gmsh::model::mesh::getElementType("Hexahedron", 1), quadrangle = gmsh::model::mesh::getElementType("Quadrangle", 1),
            point = gmsh::model::mesh::getElementType("Point", 1);
  const auto corner = hexahedron_order(hexahedron);
  for (std::size_t b = 0; b < mesh.bodies.size(); ++b) {
    const int volume = gmsh::model::addDiscreteEntity(3, static_cast<int>(b) + 1);
    if (b == 0) gmsh::model::mesh::addNodes(3, volume, tags, X);
    std::vector<std::size_t> cells, nodes;
    for (int e = 0; e < mesh.n_cells(); ++e) {
      if (mesh.body[e] != static_cast<int>(b)) continue;
      cells.push_back(static_cast<std::size_t>(e) + 1);
      std::array<std::size_t, 8> own;
      for (int a = 0; a < 8; ++a) own[static_cast<std::size_t>(corner[a])] = static_cast<std::size_t>(mesh.cell(e)[a]) + 1;
      nodes.insert(nodes.end(), own.begin(), own.end());
    }
    gmsh::model::mesh::addElementsByType(volume, hexahedron, cells, nodes);
    gmsh::model::setPhysicalName(3, gmsh::model::addPhysicalGroup(3, {volume}), mesh.bodies[b]);
  }
  // an element of gmsh is of one surface: one for each combination of sets; points likewise
  std::size_t next = static_cast<std::size_t>(mesh.n_cells()) + 1;
  std::map<std::pair<int, int>, std::set<std::string>> sets_of_facet;
  std::map<int, std::set<std::string>> sets_of_node;
  for (const auto& [name, facets] : mesh.facet_sets)
    for (const Facet& f : facets) sets_of_facet[{f.cell, f.local}].insert(name);
  for (const auto& [name, nodes] : mesh.node_sets) {
    const auto facets = mesh.facet_sets.find(name);
    if (facets != mesh.facet_sets.end() && nodes_of(mesh, facets->second) == nodes) continue;  // said by the facets
    for (int n : nodes) sets_of_node[n].insert(name);
  }
  const auto add = [&](int dim, int type, const auto& sets_of, const auto& nodes_of_one) {
    std::map<std::set<std::string>, std::vector<std::size_t>> parts;
    for (const auto& [one, sets] : sets_of)
      for (int n : nodes_of_one(one)) parts[sets].push_back(static_cast<std::size_t>(n) + 1);
    std::map<std::string, std::vector<int>> entities;
    for (const auto& [sets, nodes] : parts) {
      const int entity = gmsh::model::addDiscreteEntity(dim);
      std::vector<std::size_t> elements(nodes.size() / (dim == 2 ? 4 : 1));
      for (std::size_t& element : elements) element = next++;
      gmsh::model::mesh::addElementsByType(entity, type, elements, nodes);
      for (const std::string& name : sets) entities[name].push_back(entity);
    }
    for (const auto& [name, of] : entities) gmsh::model::setPhysicalName(dim, gmsh::model::addPhysicalGroup(dim, of), name);
  };
  add(2, quadrangle, sets_of_facet, [&](const std::pair<int, int>& f) { return facet_nodes(mesh, {f.first, f.second}); });
  add(0, point, sets_of_node, [](int n) { return std::vector<int>{n}; });
  gmsh::option::setNumber("Mesh.MshFileVersion", 4.1);
  gmsh::option::setNumber("Mesh.Binary", 0);
  gmsh::option::setNumber("Mesh.SaveAll", 0);
  const std::string part = path + ".part.msh";
  try {
    gmsh::write(part);
  } catch (...) {
    throw Failure(Exit::input, Error{{path}, "", "cannot be written", "", ""});
  }
  std::filesystem::rename(part, path);
}

}  // namespace langer
