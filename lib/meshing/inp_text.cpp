// What Abaqus and CalculiX read of a mesh.
#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "mechanics/mesh/reference.hpp"
#include "meshing/exchange.hpp"

namespace langer {

namespace {

std::string quoted_name(const std::string& name) {
  if (name.find_first_of("\",\n\r*=") != std::string::npos)
    throw Failure(Exit::config, Error{{},
                                      "export",
                                      "the name \"" + name + "\" is not possible in an .inp file",
                                      "names without , \" * and =",
                                      ""});
  if (name.find(' ') == std::string::npos) return name;
  return "\"" + name + "\"";
}

}  // namespace

std::string inp_text(const Mesh& mesh) {
  std::string s = "** a mesh of Langer; mm\n*NODE\n";
  for (int n = 0; n < mesh.n_nodes(); ++n)
    s += fmt::format("{}, {}, {}, {}\n", n + 1, mesh.X[n][0], mesh.X[n][1], mesh.X[n][2]);
  for (std::size_t b = 0; b < mesh.bodies.size(); ++b) {
    s += fmt::format("*ELEMENT, TYPE={}, ELSET={}\n", mesh.cell().names.abaqus.written,
                     quoted_name(mesh.bodies[b]));
    for (int e = 0; e < mesh.n_cells(); ++e) {
      if (mesh.body[e] != static_cast<int>(b)) continue;
      s += std::to_string(e + 1);
      for (int n : mesh.cell(e)) s += ", " + std::to_string(n + 1);
      s += "\n";
    }
  }
  for (const auto& [name, nodes] : mesh.node_sets) {
    s += fmt::format("*NSET, NSET={}\n", quoted_name(name));
    for (std::size_t i = 0; i < nodes.size(); ++i)
      s += fmt::format("{},{}", nodes[i] + 1, i % 16 == 15 || i + 1 == nodes.size() ? "\n" : " ");
  }
  for (const auto& [name, facets] : mesh.facet_sets) {
    s += fmt::format("*SURFACE, NAME={}, TYPE=ELEMENT\n", quoted_name(name));
    const std::vector<int>& sides = mesh.cell().names.abaqus.sides;
    for (const Facet& facet : facets)
      s += fmt::format("{}, S{}\n", facet.cell + 1,
                       std::find(sides.begin(), sides.end(), facet.local) - sides.begin() + 1);
  }
  return s;
}

}  // namespace langer
