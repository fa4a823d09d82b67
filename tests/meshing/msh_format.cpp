// Files of Gmsh: what our reader finds in them is what gmsh itself finds, in every variant of the
// format that gmsh writes.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.hpp"
#include "core/base/input_file.hpp"
#include "core/base/traps.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/quality.hpp"
#include "meshing/exchange.hpp"
#include "meshing/gmsh/gmsh_session.hpp"
#include "meshing/msh_mesh.hpp"
#include "meshing/parse_msh.hpp"
#include "support/block.hpp"
#include "support/near.hpp"

using namespace langer;

namespace msh_format_tests {

namespace {

std::string folder() {
  const auto path = std::filesystem::path(BINARY_DIR) / "test_files" / "msh_format";
  std::filesystem::create_directories(path);
  return path.string();
}

std::vector<MshElements> elements_in_gmsh(int dim, int entity) {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags;
  std::vector<std::vector<std::size_t>> nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, dim, entity);
  std::vector<MshElements> all;
  for (std::size_t t = 0; t < types.size(); ++t) {
    MshElements of{types[t], "", tags[t], nodes[t], {}};
    int type_dim = 0;
    int order = 0;
    int n_nodes = 0;
    int n_primary = 0;
    std::vector<double> xi;
    gmsh::model::mesh::getElementProperties(of.type, of.name, type_dim, order, n_nodes, xi,
                                            n_primary);
    all.push_back(of);
  }
  return all;
}

// the same file, read by gmsh
MshModel read_by_gmsh(const std::string& path) {
  const NoTraps in_gmsh;
  const GmshSession session;
  gmsh::merge(path);
  MshModel model;
  model.cells = elements_in_gmsh(3, -1);
  std::vector<double> parametric;
  gmsh::model::mesh::getNodes(model.node_tags, model.X, parametric);
  gmsh::vectorpair pairs;
  gmsh::model::getPhysicalGroups(pairs);
  for (const auto& [dim, tag] : pairs) {
    MshGroup group{dim, tag, "", {}, {}};
    gmsh::model::getPhysicalName(dim, tag, group.name);
    std::vector<int> entities;
    std::vector<double> X;
    gmsh::model::getEntitiesForPhysicalGroup(dim, tag, entities);
    if (dim < 2) gmsh::model::mesh::getNodesForPhysicalGroup(dim, tag, group.nodes, X);
    if (dim >= 2)
      for (const int entity : entities)
        for (const MshElements& of : elements_in_gmsh(dim, entity)) group.elements.push_back(of);
    model.groups.push_back(group);
  }
  return model;
}

// Sets as texts, so that a difference can be read.
std::map<std::string, std::string> sets_of(const Mesh& mesh) {
  std::map<std::string, std::string> sets;
  for (const auto& [name, facets] : mesh.facet_sets)
    for (const Facet& facet : facets)
      sets["facets " + name] += fmt::format("{}.{} ", facet.cell, facet.local);
  for (const auto& [name, nodes] : mesh.node_sets)
    sets["nodes " + name] = fmt::format("{}", fmt::join(nodes, " "));
  return sets;
}

// Returns what our reader made, for further checks.
Mesh check_against_gmsh(const std::string& path) {
  CAPTURE(path);
  std::vector<std::string> own_notes;
  std::vector<std::string> notes;
  const Mesh own = read_msh(path, own_notes);
  const Mesh other = mesh_of(read_by_gmsh(path), path, notes);
  CHECK(own.type == other.type);
  CHECK(own.X == other.X);
  CHECK(own.connectivity == other.connectivity);
  CHECK(own.bodies == other.bodies);
  CHECK(own.body == other.body);
  const auto sets = sets_of(own);
  const auto other_sets = sets_of(other);
  CHECK(sets.size() == other_sets.size());
  for (const auto& [name, set] : sets) {
    const auto shown = name;
    CAPTURE(shown);
    REQUIRE(other_sets.contains(name));
    CHECK(set == other_sets.at(name));
  }
  CHECK(own_notes == notes);
  return own;
}

struct Variant {
  double version;
  int is_binary;
};
constexpr Variant variants[] = {{1, 0}, {2, 0}, {2.2, 0}, {2.2, 1}, {4, 0}, {4.1, 0}, {4.1, 1}};

// Writes the model that `make` draws in each variant of the format.
void for_each_variant(
    const std::string& name, const std::function<void()>& make,
    const std::function<void(const std::string&, Variant)>& check,
    const std::function<void()>& before_writing = [] {}) {
  for (const Variant& variant : variants) {
    const std::string path = folder() + "/" + name + "_" +
                             std::to_string(int(10 * variant.version)) + "_" +
                             std::to_string(variant.is_binary) + ".msh";
    {
      const NoTraps in_gmsh;
      const GmshSession session;
      make();
      gmsh::option::setNumber("Mesh.MshFileVersion", variant.version);
      gmsh::option::setNumber("Mesh.Binary", variant.is_binary);
      before_writing();
      gmsh::write(path);
    }
    check(path, variant);
  }
}

void name_group(int dim, const std::vector<int>& tags, const std::string& name) {
  gmsh::model::setPhysicalName(dim, gmsh::model::addPhysicalGroup(dim, tags), name);
}

// a cylinder on a box, as tetrahedra
void draw_tetrahedra() {
  gmsh::model::occ::addBox(-8, 0, -8, 16, 2, 16);
  gmsh::model::occ::addCylinder(0, 2, 0, 0, 2, 0, 6);
  gmsh::model::occ::removeAllDuplicates();
  gmsh::model::occ::synchronize();
  gmsh::vectorpair volumes;
  gmsh::vectorpair surfaces;
  gmsh::model::getEntities(volumes, 3);
  gmsh::model::getEntities(surfaces, 2);
  REQUIRE(volumes.size() == 2);
  name_group(3, {volumes[0].second}, "lower body");
  gmsh::model::addPhysicalGroup(3, {volumes[1].second}, 77);  // without a name
  name_group(2, {surfaces[0].second, surfaces[1].second}, "two");
  gmsh::model::addPhysicalGroup(2, {surfaces[2].second});
  gmsh::vectorpair curves;
  gmsh::vectorpair points;
  gmsh::model::getEntities(curves, 1);
  gmsh::model::getEntities(points, 0);
  name_group(1, {curves[0].second, curves[1].second, curves[4].second}, "curves");
  name_group(0, {points[0].second}, "corner");
  gmsh::model::addPhysicalGroup(0, {points[1].second, points[2].second});
  gmsh::option::setNumber("Mesh.MeshSizeMin", 4);
  gmsh::option::setNumber("Mesh.MeshSizeMax", 4);
  gmsh::model::mesh::generate(3);
}

// a block of 3 x 2 x 2 hexahedra
void draw_hexahedra() {
  namespace geo = gmsh::model::geo;
  gmsh::vectorpair shape{{0, geo::addPoint(0, 0, 0)}};
  for (const std::array<double, 4>& to :
       {std::array<double, 4>{3, 0, 0, 3}, {0, 2, 0, 2}, {0, 0, 1, 2}}) {
    gmsh::vectorpair extruded;
    geo::extrude(shape, to[0], to[1], to[2], extruded, {static_cast<int>(to[3])}, {1}, true);
    for (const auto& [dim, tag] : extruded)
      if (dim == shape[0].first + 1) {
        shape = {{dim, tag}};
        break;
      }
  }
  geo::synchronize();
  name_group(3, {shape[0].second}, "block");
  gmsh::vectorpair surfaces;
  gmsh::model::getEntities(surfaces, 2);
  name_group(2, {surfaces[0].second}, "first");
  name_group(2, {-surfaces[3].second, surfaces[4].second}, "turned");
  name_group(1, {1}, "edge");
  name_group(0, {1, 4}, "corners");
  gmsh::model::mesh::generate(3);
}

}  // namespace

TEST_CASE("tetrahedra that gmsh writes are read as gmsh reads them, in every variant") {
  for_each_variant("tetrahedra", draw_tetrahedra, [](const std::string& path, Variant variant) {
    const Mesh mesh = check_against_gmsh(path);
    CHECK(mesh.type == CellType::tet15);
    CHECK(mesh.bodies.size() == 2);
    CHECK(mesh.facet_sets.size() == 2);
    CHECK(mesh.node_sets.size() == 2 + 3);  // facets' nodes, curves, two of points
    if (variant.version > 2) CHECK(mesh.bodies[0] == "lower body");
  });
}

TEST_CASE("hexahedra that gmsh writes are read as gmsh reads them, in every variant") {
  for_each_variant("hexahedra", draw_hexahedra, [](const std::string& path, Variant) {
    const Mesh mesh = check_against_gmsh(path);
    CHECK(mesh.type == CellType::hex8);
    CHECK(mesh.n_cells() == 12);
    CHECK(quality(mesh).volume == near(6, 1e-12));
  });
}

TEST_CASE("parameters of nodes, all entities and periodic faces do not change what is read") {
  const auto check = [](const std::string& path, Variant variant) {
    if (variant.version >= 2) check_against_gmsh(path);  // format 1 has no parameters
  };
  for_each_variant("parametric", draw_tetrahedra, check,
                   [] { gmsh::option::setNumber("Mesh.SaveParametric", 1); });
  for_each_variant("all", draw_hexahedra, check,
                   [] { gmsh::option::setNumber("Mesh.SaveAll", 1); });
  const auto draw_periodic = [] {
    gmsh::model::occ::addBox(0, 0, 0, 2, 2, 2);
    gmsh::model::occ::synchronize();
    gmsh::model::mesh::setPeriodic(2, {2}, {1}, {1, 0, 0, 2, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    name_group(3, {1}, "cell");
    name_group(2, {1, 2}, "sides");
    gmsh::option::setNumber("Mesh.MeshSizeMin", 1);
    gmsh::option::setNumber("Mesh.MeshSizeMax", 1);
    gmsh::model::mesh::generate(3);
  };
  for_each_variant("periodic", draw_periodic, check);
}

TEST_CASE("a mesh that gmsh divided into parts is read as the whole that it was") {
  for_each_variant(
      "parts", draw_tetrahedra,
      [](const std::string& path, Variant variant) {
        CAPTURE(path);
        std::vector<std::string> notes;
        if (variant.version == 4) {
          CHECK_THROWS_WITH_AS(read_msh(path, notes), doctest::Contains("in parts"), Failure);
          return;
        }
        if (variant.version < 2.1) return;
        // gmsh adds a group for each part to those of format 2
        Mesh mesh = read_msh(path, notes);
        if (variant.version > 4) mesh = check_against_gmsh(path);
        const std::string end = path.substr(path.find("parts_") + 5);
        const Mesh whole = read_msh(folder() + "/tetrahedra" + end, notes);
        CHECK(mesh.n_nodes() == whole.n_nodes());
        CHECK(mesh.n_cells() == whole.n_cells());
        CHECK(mesh.bodies == whole.bodies);
        for (const char* name : {"two", "curves", "corner"})
          CHECK(mesh.node_sets.at(name).size() == whole.node_sets.at(name).size());
        CHECK(mesh.facet_sets.at("two").size() == whole.facet_sets.at("two").size());
        CHECK(quality(mesh).volume == near(quality(whole).volume, 1e-12));
      },
      [] {
        // the same before it is divided
        const std::string whole = folder() + "/tetrahedra_";
        double version = 0;
        double is_binary = 0;
        gmsh::option::getNumber("Mesh.MshFileVersion", version);
        gmsh::option::getNumber("Mesh.Binary", is_binary);
        gmsh::write(fmt::format("{}{:.0f}_{:.0f}.msh", whole, 10 * version, is_binary));
        gmsh::model::mesh::partition(3);
      });
}

TEST_CASE("numbers with large gaps, unused nodes and sections of results are no obstacle") {
  for_each_variant(
      "gaps",
      [] {
        gmsh::model::addDiscreteEntity(3, 4);
        std::vector<std::size_t> tags{7, 2000000000, 30, 40, 50, 1234567, 70, 80, 2147483647};
        std::vector<double> X{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0,
                              1, 1, 0, 1, 1, 1, 1, 0, 1, 1, 9, 9, 9};
        gmsh::model::mesh::addNodes(3, 4, tags, X);
        tags.pop_back();
        gmsh::model::mesh::addElementsByType(4, 5, {987654321}, tags);
        name_group(3, {4}, "cube");
      },
      [](const std::string& path, Variant variant) {
        if (variant.version == 4.1 && variant.is_binary == 0) {
          // as a post-processor adds them, with lines that look like sections inside
          std::ofstream(path, std::ios::app)
              << "$Comments\nSystemCall \"touch ran\";\n$Nodes 5\n$EndComments\n"
                 "$NodeData\n1\n\"u\"\n1\n0.0\n3\n0\n1\n1\n7 0.5\n$EndNodeData\n";
        }
        const Mesh mesh = check_against_gmsh(path);
        CHECK(mesh.n_nodes() == 8);
        CHECK(quality(mesh).volume == near(1, 1e-12));
      });
}

TEST_CASE("an element that format 2 lists once for each of its groups is in each of them") {
  std::vector<std::string> notes;
  const auto draw = [] {
    gmsh::model::occ::addBox(0, 0, 0, 1, 1, 1);
    gmsh::model::occ::synchronize();
    name_group(3, {1}, "box");
    name_group(2, {1, 2}, "one");
    name_group(2, {2, 3}, "other");
    gmsh::option::setNumber("Mesh.MeshSizeMin", 1);
    gmsh::option::setNumber("Mesh.MeshSizeMax", 1);
    gmsh::model::mesh::generate(3);
  };
  std::vector<Mesh> meshes;
  for_each_variant("shared", draw, [&](const std::string& path, Variant variant) {
    if (variant.version < 2.1) return;
    meshes.push_back(read_msh(path, notes));
    if (variant.version > 3) check_against_gmsh(path);
  });
  for (const Mesh& mesh : meshes) {
    CHECK(sets_of(mesh) == sets_of(meshes.back()));
    CHECK(mesh.facet_sets.at("one").size() == 8);
    CHECK(mesh.facet_sets.at("other").size() == 8);
  }
  CHECK(notes.empty());
}

}  // namespace msh_format_tests
