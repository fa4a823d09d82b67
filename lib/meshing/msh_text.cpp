// Meshes written for Gmsh: sets and bodies become physical groups (MSH 4.1, text).
#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/reference.hpp"
#include "meshing/exchange.hpp"
#include "meshing/msh_types.hpp"

namespace langer {

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
  std::size_t n_parts = parts.volumes.size();
  std::size_t n_elements = n_cells;
  for (const auto& of_one_dimension : parts.all)
    for (const auto& [sets, part] : of_one_dimension) {
      ++n_parts;
      n_elements += part.elements.size();
    }
  fmt::format_to(out, "$Elements\n{} {} 1 {}\n", n_parts, n_elements, n_elements);
  std::size_t next = n_cells;
  for (const auto& [dim, type] :
       {std::pair{0, msh_type::point}, {2, mesh.cell().names.gmsh_facet}}) {
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
