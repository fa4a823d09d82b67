#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/input_file.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/raise.hpp"
#include "mechanics/mesh/reference.hpp"
#include "meshing/exchange.hpp"
#include "meshing/msh_mesh.hpp"
#include "meshing/parse_msh.hpp"

// The mesh of a Gmsh model (msh_model.hpp): its groups become bodies, facet sets and node sets.
// Nodes and cells are numbered by ascending tag, so that the order of the file does not matter.
namespace langer {

namespace {

// Groups without a name are called after their kind and number. Of groups of one name the one of
// the highest dimension comes first: a node set of its own then replaces the nodes of facets.
std::vector<MshGroup> named(std::vector<MshGroup> groups) {
  constexpr const char* kinds[] = {"points", "curves", "surfaces", "volume"};
  for (MshGroup& group : groups)
    if (group.name.empty()) group.name = fmt::format("{}_{}", kinds[group.dim], group.tag);
  std::ranges::stable_sort(groups, std::ranges::greater{}, &MshGroup::dim);
  return groups;
}

// What cells of a type of Gmsh become: of our cells with its corners the one with the fewest nodes.
// nullptr: no cell of ours.
const ReferenceCell* cell_of(int type) {
  const ReferenceCell* found = nullptr;
  for (const ReferenceCell& cell : reference_cells()) {
    if (cell.names.gmsh != type) continue;
    if (!found || cell.n_nodes < found->n_nodes) found = &cell;
  }
  return found;
}

class MeshBuilder {
 public:
  MeshBuilder(const std::string& path, std::vector<std::string>& notes)
      : path_(path), notes_(notes) {}

  Mesh build(const MshModel& model) {
    const MshElements& cells = only_cells(model);
    add_nodes(model, cells);
    add_cells(cells);
    refuse_equal_names(model.groups);
    for (const MshGroup& group : named(model.groups)) {
      if (group.dim == 3) add_body(group);
      if (group.dim == 2) add_facet_set(group);
      if (group.dim < 2) add_node_set(group);
    }
    add_nameless_body();
    return std::move(mesh_);
  }

 private:
  std::string path_;
  std::vector<std::string>& notes_;
  Mesh mesh_;
  std::map<std::size_t, int> node_at_;  // by tag, those that cells have
  std::map<std::size_t, int> cell_at_;  // by tag
  std::map<std::array<int, 4>, Facet> facet_at_;

  [[noreturn]] void refuse(const std::string& found, const std::string& expected = "",
                           int line = 0) const {
    Place place{path_, line, 0};
    if (line > 0) place.column = 1;
    throw Failure(Exit::input, Error{place, "", found, expected, ""});
  }

  static int line_of(const MshElements& elements, std::size_t element) {
    if (elements.lines.empty()) return 0;
    return elements.lines[element];
  }

  const MshElements& only_cells(const MshModel& model) const {
    const char* expected = "8-node hexahedra only, or 4-node tetrahedra only";
    for (const MshElements& of : model.cells)
      if (!cell_of(of.type)) refuse("found cells of the kind " + of.name, expected, line_of(of, 0));
    if (model.cells.empty()) refuse("no cells", expected);
    if (model.cells.size() > 1) refuse("hexahedra together with tetrahedra", expected);
    return model.cells[0];
  }

  // Nodes by ascending tag, without those that no cell has.
  void add_nodes(const MshModel& model, const MshElements& cells) {
    std::map<std::size_t, std::size_t> place;
    for (std::size_t i = 0; i < model.node_tags.size(); ++i) place[model.node_tags[i]] = i;
    const std::set<std::size_t> used(cells.nodes.begin(), cells.nodes.end());
    for (const std::size_t tag : used) {
      const auto found = place.find(tag);
      if (found == place.end())
        refuse(fmt::format("a cell has the node {}, which is not there", tag));
      node_at_[tag] = mesh_.n_nodes();
      mesh_.X.emplace_back(model.X.data() + 3 * found->second);
      if (!mesh_.X.back().allFinite())
        refuse(fmt::format("the position of the node {} is not finite", tag));
    }
  }

  // Cells by ascending tag.
  void add_cells(const MshElements& cells) {
    const ReferenceCell& cell = *cell_of(cells.type);
    const auto n_corners = static_cast<std::size_t>(cell.n_corners);
    std::vector<std::pair<std::size_t, std::size_t>> order;  // tag and place
    for (std::size_t e = 0; e < cells.tags.size(); ++e) order.emplace_back(cells.tags[e], e);
    std::sort(order.begin(), order.end());

    std::vector<int> corners;
    std::map<std::vector<int>, std::size_t> cell_with;  // these corners, sorted: its tag
    for (const auto& [tag, e] : order) {
      const int line = line_of(cells, e);
      const int number = static_cast<int>(corners.size() / n_corners);
      const bool is_new = cell_at_.try_emplace(tag, number).second;
      if (!is_new) refuse(fmt::format("cell {} is there twice", tag), "", line);
      std::vector<int> of_cell;
      for (std::size_t a = 0; a < n_corners; ++a)
        of_cell.push_back(node_at_.at(cells.nodes[n_corners * e + a]));
      corners.insert(corners.end(), of_cell.begin(), of_cell.end());
      std::sort(of_cell.begin(), of_cell.end());
      if (std::adjacent_find(of_cell.begin(), of_cell.end()) != of_cell.end())
        refuse(fmt::format("cell {} has one node twice", tag), "", line);
      const auto [other, is_first] = cell_with.try_emplace(of_cell, tag);
      if (!is_first)
        refuse(fmt::format("cells {} and {} have the same nodes", other->second, tag),
               "one physical volume for each cell, and every cell once", line);
    }
    mesh_ = raised(mesh_.X, corners, cell.type);
    mesh_.body.assign(static_cast<std::size_t>(mesh_.n_cells()), -1);
  }

  // The second set would silently replace the first.
  void refuse_equal_names(const std::vector<MshGroup>& groups) const {
    constexpr const char* kinds[] = {"points", "curves", "surfaces", "volumes"};
    std::set<std::pair<int, std::string>> known;
    for (const MshGroup& group : groups) {
      if (group.name.empty()) continue;
      if (!known.emplace(group.dim, group.name).second)
        refuse(fmt::format("two groups of {} have the name \"{}\"", kinds[group.dim], group.name),
               "different names");
    }
  }

  // A group of dimension 3 is a body. A cell has one body only.
  void add_body(const MshGroup& group) {
    const int body = static_cast<int>(mesh_.bodies.size());
    mesh_.bodies.push_back(group.name);
    for (const MshElements& of : group.elements) {
      for (std::size_t i = 0; i < of.tags.size(); ++i) {
        const auto cell = cell_at_.find(of.tags[i]);
        if (cell == cell_at_.end())
          refuse(fmt::format("the volume \"{}\" has the cell {}, which is not there", group.name,
                             of.tags[i]));
        int& body_of_cell = mesh_.body[static_cast<std::size_t>(cell->second)];
        if (body_of_cell >= 0)
          refuse(fmt::format("cell {} belongs to \"{}\" and to \"{}\"", of.tags[i],
                             mesh_.bodies[static_cast<std::size_t>(body_of_cell)], group.name),
                 "one physical volume for each cell", line_of(of, i));
        body_of_cell = body;
      }
    }
  }

  // Cells of no group are a body without a name.
  void add_nameless_body() {
    if (std::count(mesh_.body.begin(), mesh_.body.end(), -1) == 0) return;
    for (int& body : mesh_.body)
      if (body < 0) body = static_cast<int>(mesh_.bodies.size());
    mesh_.bodies.push_back("");
  }

  // The facet of each set of corners, needed once there is a group of surfaces.
  void find_facets() {
    if (!facet_at_.empty()) return;
    for (int e = mesh_.n_cells() - 1; e >= 0; --e)  // of two cells that share one the first
      for (int f = 0; f < mesh_.cell().n_facets(); ++f)
        facet_at_[facet_key(mesh_, {e, f})] = {e, f};
  }

  // A group of dimension 2: its faces have to be facets of cells.
  void add_facet_set(const MshGroup& group) {
    find_facets();
    std::vector<Facet> facets;
    const ReferenceCell& cell = mesh_.cell();
    const auto n_corners = static_cast<std::size_t>(cell.facet_corners);
    for (const MshElements& of : group.elements) {
      if (of.type != cell.names.gmsh_facet)
        refuse(fmt::format("the surface \"{}\" has faces of the kind {}", group.name, of.name),
               fmt::format("{}, the facets of {}", cell.names.facet_shape, cell.names.shape),
               line_of(of, 0));
      for (std::size_t i = 0; i < of.tags.size(); ++i) {
        std::array<int, 4> key{-1, -1, -1, -1};
        for (std::size_t k = 0; k < n_corners; ++k) {
          const auto node = node_at_.find(of.nodes[n_corners * i + k]);
          if (node != node_at_.end()) key[k] = node->second;
        }
        std::sort(key.begin(), key.end());
        const auto facet = facet_at_.find(key);
        if (facet == facet_at_.end())
          refuse(
              fmt::format("the surface \"{}\" has a face that is no facet of a cell", group.name),
              "", line_of(of, i));
        facets.push_back(facet->second);
      }
    }
    if (facets.empty()) {
      notes_.push_back("left out, as it has no faces: surface " + group.name);
      return;
    }
    // A file may list a face twice; a load on it must not count twice.
    const auto place = [](const Facet& facet) {
      return std::pair(facet.cell, facet.local);
    };
    std::sort(facets.begin(), facets.end(),
              [&](const Facet& a, const Facet& b) { return place(a) < place(b); });
    const auto last =
        std::unique(facets.begin(), facets.end(),
                    [&](const Facet& a, const Facet& b) { return place(a) == place(b); });
    facets.erase(last, facets.end());
    name_facets(mesh_, group.name, facets);
  }

  // A group of points or curves: the nodes of its elements that cells have.
  void add_node_set(const MshGroup& group) {
    std::set<int> nodes;
    for (const std::size_t tag : group.nodes) {
      const auto node = node_at_.find(tag);
      if (node != node_at_.end()) nodes.insert(node->second);
    }
    if (nodes.empty())
      notes_.push_back("left out, as no cell has its nodes: " + group.name);
    else
      mesh_.node_sets[group.name] = {nodes.begin(), nodes.end()};
  }
};

}  // namespace

Mesh mesh_of(const MshModel& model, const std::string& path, std::vector<std::string>& notes) {
  return MeshBuilder(path, notes).build(model);
}

Mesh read_msh(const std::string& path, std::vector<std::string>& notes) {
  return mesh_of(parse_msh(read_file(path, "a mesh of Gmsh"), path), path, notes);
}

}  // namespace langer
