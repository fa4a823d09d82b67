// Gmsh's meshes, read by gmsh, written by ourselves: physical groups are bodies, facet sets and
// node sets.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/quality.hpp"
#include "mechanics/mesh/raise.hpp"
#include "mechanics/mesh/reference.hpp"
#include "meshing/exchange.hpp"
#include "meshing/gmsh/gmsh_load.hpp"

namespace langer {

namespace {

using namespace gmsh_module;

// each by a name; of one name what has more to say comes first: a node set of its own replaces the
// nodes of facets
std::vector<Group> named(std::vector<Group> groups) {
  constexpr const char* kinds[] = {"points", "curves", "surfaces", "volume"};
  for (Group& g : groups)
    if (g.name.empty()) g.name = fmt::format("{}_{}", kinds[g.dim], g.tag);
  std::stable_sort(groups.begin(), groups.end(),
                   [](const Group& a, const Group& b) { return a.dim > b.dim; });
  return groups;
}

// what cells of a type of gmsh's become: of those with its corners the one with the fewest nodes;
// none: no cell of ours
const ReferenceCell* cell_of(int gmsh_type) {
  const ReferenceCell* found = nullptr;
  for (const ReferenceCell& cell : reference_cells())
    if (cell.names.gmsh == gmsh_type && (!found || cell.n_nodes < found->n_nodes)) found = &cell;
  return found;
}

class MshReader {
 public:
  MshReader(const std::string& path, std::vector<std::string>& notes)
      : path_(path), notes_(notes) {}

  Mesh made_of(const Model& model) {
    const char* expected = "8-node hexahedra only, or 4-node tetrahedra only";
    for (const Elements& of : model.cells)
      if (!cell_of(of.type)) refuse("found cells of the kind " + of.name, expected);
    if (model.cells.size() != 1)
      refuse(model.cells.empty() ? "no cells" : "hexahedra beside tetrahedra", expected);
    const Elements& cells = model.cells[0];

    const std::vector<std::size_t>& tags = model.node_tags;
    std::map<std::size_t, std::size_t> place;  // by tag, ascending
    for (std::size_t i = 0; i < tags.size(); ++i) place[tags[i]] = i;
    const std::set<std::size_t> used(cells.nodes.begin(), cells.nodes.end());
    for (std::size_t tag : used) {
      const auto found = place.find(tag);
      if (found == place.end())
        refuse(fmt::format("a cell has the node {}, which is not there", tag));
      node_at_[tag] = mesh_.n_nodes();
      mesh_.X.emplace_back(model.X.data() + 3 * found->second);
      if (!mesh_.X.back().allFinite())
        refuse(fmt::format("the position of the node {} is not finite", tag));
    }
    std::vector<std::pair<std::size_t, std::size_t>> order;  // tag, place
    for (std::size_t e = 0; e < cells.tags.size(); ++e) order.emplace_back(cells.tags[e], e);
    std::sort(order.begin(), order.end());
    const ReferenceCell& cell = *cell_of(cells.type);
    const auto n_corners = static_cast<std::size_t>(cell.n_corners);
    std::vector<int> corners;
    for (const auto& [tag, e] : order) {
      cell_at_[tag] = static_cast<int>(corners.size() / n_corners);
      for (std::size_t a = 0; a < n_corners; ++a)
        corners.push_back(node_at_.at(cells.nodes[n_corners * e + a]));
    }
    mesh_ = raised(mesh_.X, corners, cell.type);
    mesh_.body.assign(static_cast<std::size_t>(mesh_.n_cells()), -1);
    for (const Group& group : named(model.groups)) {
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
  Mesh mesh_;
  std::map<std::size_t, int> node_at_, cell_at_;
  std::map<std::array<int, 4>, Facet> facet_at_;

  void add_body(const Group& group) {
    const int body = static_cast<int>(mesh_.bodies.size());
    mesh_.bodies.push_back(group.name);
    for (const Elements& of : group.elements)
      for (std::size_t tag : of.tags) {
        int& body_of = mesh_.body[cell_at_.at(tag)];
        if (body_of >= 0)
          refuse(fmt::format("cell {} belongs to \"{}\" and to \"{}\"", tag, mesh_.bodies[body_of],
                             group.name),
                 "one physical volume for each cell");
        body_of = body;
      }
  }

  void add_facets(const Group& group) {
    if (facet_at_.empty())
      for (int e = mesh_.n_cells() - 1; e >= 0; --e)  // of two cells that share it the first
        for (int f = 0; f < mesh_.cell().n_facets(); ++f)
          facet_at_[facet_key(mesh_, {e, f})] = {e, f};
    std::vector<Facet> facets;
    const ReferenceCell& cell = mesh_.cell();
    const auto n_corners = static_cast<std::size_t>(cell.facet_corners);
    for (const Elements& of : group.elements) {
      if (of.type != cell.names.gmsh_facet)
        refuse(fmt::format("the surface \"{}\" has faces of the kind {}", group.name, of.name),
               fmt::format("{}, the facets of {}", cell.names.facet_shape, cell.names.shape));
      for (std::size_t i = 0; i < of.nodes.size(); i += n_corners) {
        std::array<int, 4> key{-1, -1, -1, -1};
        for (std::size_t k = 0; k < n_corners; ++k) {
          const auto node = node_at_.find(of.nodes[i + k]);
          key[k] = node == node_at_.end() ? -1 : node->second;
        }
        std::sort(key.begin(), key.end());
        const auto facet = facet_at_.find(key);
        if (facet == facet_at_.end())
          refuse(
              fmt::format("the surface \"{}\" has a face that is no facet of a cell", group.name));
        facets.push_back(facet->second);
      }
    }
    std::sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) {
      return std::pair(a.cell, a.local) < std::pair(b.cell, b.local);
    });
    if (facets.empty())
      notes_.push_back("left out, as it has no faces: surface " + group.name);
    else
      name_facets(mesh_, group.name, facets);
  }

  void add_nodes(const Group& group) {
    std::set<int> nodes;
    for (std::size_t tag : group.nodes)
      if (const auto node = node_at_.find(tag); node != node_at_.end()) nodes.insert(node->second);
    if (nodes.empty())
      notes_.push_back("left out, as no cell has its nodes: " + group.name);
    else
      mesh_.node_sets[group.name] = {nodes.begin(), nodes.end()};
  }
};

}  // namespace

Mesh read_msh(const std::string& path, std::vector<std::string>& notes) {
  return MshReader(path, notes).made_of(read_by_gmsh(path));
}

Mesh read_solid(const std::string& path, bool facets, double edge, CellType cells,
                std::vector<std::string>& notes) {
  gmsh_module::SolidOrder order{facets, edge, reference(cells).hexahedron()};
  const auto meshed = [&] {
    const Model model = mesh_by_gmsh(path, order);
    MshReader reader(path, notes);
    if (!model.has_volumes)
      reader.refuse("no solid body",
                    facets ? "triangles that enclose one" : "a STEP file with a solid");
    return reader.made_of(model);
  };
  const std::vector<std::string> before = notes;
  Mesh mesh = meshed();
  if (!order.hexahedra || quality(mesh).least_jacobian > 0) return mesh;
  const std::vector<std::string> of_curved = std::exchange(notes, before);
  order.straight = true;
  Mesh straight = meshed();
  const double volume = quality(mesh).volume,
               lost = std::abs(quality(straight).volume / volume - 1);
  if (!(lost < 0.01)) {  // another body: the folded cells are refused
    notes = of_curved;
    return mesh;
  }
  notes.push_back(fmt::format(
      "nodes on the surface would fold cells: the edges of split tetrahedra stay straight, which changes the volume by {:.2g} %",
      100 * lost));
  return straight;
}

namespace {

// the numbers of an element's line
template <class Numbers>
void add_line(std::string& s, std::size_t tag, const Numbers& nodes) {
  fmt::format_to(std::back_inserter(s), "{}", tag);
  for (int n : nodes) fmt::format_to(std::back_inserter(s), " {}", n + 1);
  s += '\n';
}

// What a .msh file has beside nodes and cells. An element is of one surface: one for each
// combination of sets; points likewise.
struct Part {
  std::vector<std::vector<int>> elements;  // their nodes
  std::vector<int> groups;
};
struct MshParts {
  std::map<std::pair<int, std::string>, int> groups;         // dimension and name: tag
  std::array<std::map<std::set<std::string>, Part>, 3> all;  // of points, nothing, surfaces
  std::vector<int> volumes;                                  // by body: its group, 0 without a name

  int group(int dim, const std::string& name) {
    if (name.find_first_of("\"\n") != std::string::npos)
      throw Failure(Exit::config, Error{{},
                                        "",
                                        "found the name '" + name + "'",
                                        "a name without quotes, as .msh has them around it",
                                        ""});
    return groups.try_emplace({dim, name}, static_cast<int>(groups.size()) + 1).first->second;
  }
  void add(int dim, const std::set<std::string>& sets, std::vector<int> nodes) {
    Part& part = all[static_cast<std::size_t>(dim)][sets];
    if (part.elements.empty())
      for (const std::string& name : sets) part.groups.push_back(group(dim, name));
    part.elements.push_back(std::move(nodes));
  }
};

MshParts parts_of(const Mesh& mesh) {
  std::map<std::pair<int, int>, std::set<std::string>> sets_of_facet;
  std::map<int, std::set<std::string>> sets_of_node;
  for (const auto& [name, facets] : mesh.facet_sets)
    for (const Facet& f : facets) sets_of_facet[{f.cell, f.local}].insert(name);
  for (const auto& [name, nodes] : mesh.node_sets) {
    const auto facets = mesh.facet_sets.find(name);
    if (facets != mesh.facet_sets.end() && nodes_of(mesh, facets->second) == nodes)
      continue;  // said by the facets
    for (int n : nodes) sets_of_node[n].insert(name);
  }
  MshParts parts;
  for (const auto& [node, sets] : sets_of_node) parts.add(0, sets, {node});
  for (const auto& [f, sets] : sets_of_facet)
    parts.add(2, sets, facet_nodes(mesh, {f.first, f.second}));
  for (const std::string& body : mesh.bodies)
    parts.volumes.push_back(body.empty() ? 0 : parts.group(3, body));
  return parts;
}

// entities by number: where they are (of points a place, else a box; gmsh finds it itself), groups,
// what bounds them
void add_entities(std::string& s, const MshParts& parts) {
  const auto out = std::back_inserter(s);
  fmt::format_to(out, "$PhysicalNames\n{}\n", parts.groups.size());
  for (const auto& [key, tag] : parts.groups)
    fmt::format_to(out, "{} {} \"{}\"\n", key.first, tag, key.second);
  fmt::format_to(out, "$EndPhysicalNames\n$Entities\n{} 0 {} {}\n", parts.all[0].size(),
                 parts.all[2].size(), parts.volumes.size());
  for (const int dim : {0, 2}) {
    int entity = 0;
    for (const auto& [sets, part] : parts.all[static_cast<std::size_t>(dim)])
      fmt::format_to(out, "{} {} {} {}{}\n", ++entity, dim == 0 ? "0 0 0" : "0 0 0 0 0 0",
                     part.groups.size(), fmt::join(part.groups, " "), dim == 0 ? "" : " 0");
  }
  for (std::size_t b = 0; b < parts.volumes.size(); ++b)
    fmt::format_to(out, "{} 0 0 0 0 0 0 {} 0\n", b + 1,
                   parts.volumes[b] == 0 ? "0" : fmt::format("1 {}", parts.volumes[b]));
  fmt::format_to(out, "$EndEntities\n");
}

void add_elements(std::string& s, const Mesh& mesh, const MshParts& parts) {
  const auto out = std::back_inserter(s);
  const auto n_cells = static_cast<std::size_t>(mesh.n_cells());
  std::size_t n_parts = parts.volumes.size(), n_elements = n_cells;
  for (const auto& of_one_dimension : parts.all)
    for (const auto& [sets, part] : of_one_dimension) ++n_parts, n_elements += part.elements.size();
  fmt::format_to(out, "$Elements\n{} {} 1 {}\n", n_parts, n_elements, n_elements);
  std::size_t next = n_cells;
  for (const auto& [dim, type] : {std::pair{0, point}, {2, mesh.cell().names.gmsh_facet}}) {
    int entity = 0;
    for (const auto& [sets, part] : parts.all[static_cast<std::size_t>(dim)]) {
      fmt::format_to(out, "{} {} {} {}\n", dim, ++entity, type, part.elements.size());
      for (const auto& nodes : part.elements) add_line(s, ++next, nodes);
    }
  }
  for (std::size_t b = 0; b < parts.volumes.size(); ++b) {
    fmt::format_to(out, "3 {} {} {}\n", b + 1, mesh.cell().names.gmsh,
                   std::count(mesh.body.begin(), mesh.body.end(), static_cast<int>(b)));
    for (std::size_t e = 0; e < n_cells; ++e)
      if (mesh.body[e] == static_cast<int>(b)) add_line(s, e + 1, mesh.cell(static_cast<int>(e)));
  }
  s += "$EndElements\n";
}

}  // namespace

std::string msh_text(const Mesh& mesh) {
  const MshParts parts = parts_of(mesh);
  std::string s = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  add_entities(s, parts);
  const auto out = std::back_inserter(s);
  fmt::format_to(out, "$Nodes\n1 {0} 1 {0}\n3 1 0 {0}\n", mesh.n_nodes());
  for (int n = 1; n <= mesh.n_nodes(); ++n) fmt::format_to(out, "{}\n", n);
  for (const Vec3& x : mesh.X) fmt::format_to(out, "{} {} {}\n", x[0], x[1], x[2]);
  s += "$EndNodes\n";
  add_elements(s, mesh, parts);
  return s;
}

}  // namespace langer
