#include "relations/mesh_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "mechanics/mesh/mesh.hpp"
#include "meshing/exchange.hpp"
#include "scene/model/make_mesh.hpp"
#include "scene/model/solve_config_io.hpp"

namespace langer::relations {

namespace {

std::string box_text(const BoxSet& box) {
  return fmt::format("{{box: {{from: {}, to: {}}}}}", vector_text(box.from), vector_text(box.to));
}

std::string geometry_text(const Body& body) {
  if (body.kind == BodyKind::block) {
    return fmt::format("block: {{origin: {}, size: {}, divisions: [{}, {}, {}]}}",
                       vector_text(body.origin), vector_text(body.size), body.divisions[0],
                       body.divisions[1], body.divisions[2]);
  }
  const char* of = "axisymmetric";
  if (body.kind == BodyKind::plane_strain) {
    of = "plane_strain";
  }
  std::string all = fmt::format(
      "section: {{of: {}, origin: [{:.17g}, {:.17g}], size: [{:.17g}, {:.17g}], divisions: [{}, {}]",
      of, body.origin[0], body.origin[1], body.size[0], body.size[1], body.divisions[0],
      body.divisions[1]);
  if (body.kind == BodyKind::plane_strain) {
    all += fmt::format(", thickness: {:.17g}", body.size[2]);
  }
  return all + "}";
}

using Tetrahedron = std::array<int, 4>;

// Six tetrahedra around the diagonal from the first corner of a hexahedron to its opposite. Cells
// of a grid that are numbered alike have the same diagonals on the facets that they share.
std::vector<Tetrahedron> divided(const Mesh& mesh) {
  constexpr std::array<std::array<int, 4>, 6> paths{
      {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}}};
  std::vector<Tetrahedron> all;
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const auto cell = mesh.cell(e);
    for (const auto& path : paths) {
      Tetrahedron t{cell[path[0]], cell[path[1]], cell[path[2]], cell[path[3]]};
      const Vec3 a = mesh.X[t[1]] - mesh.X[t[0]];
      const Vec3 b = mesh.X[t[2]] - mesh.X[t[0]];
      const Vec3 c = mesh.X[t[3]] - mesh.X[t[0]];
      if (a.cross(b).dot(c) < 0) {
        std::swap(t[1], t[2]);
      }
      all.push_back(t);
    }
  }
  return all;
}

// Faces S1 to S4 of Abaqus' tetrahedra
constexpr std::array<std::array<int, 3>, 4> tetrahedron_faces{
    {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};

std::string tetrahedra_text(const Mesh& mesh) {
  const std::vector<Tetrahedron> cells = divided(mesh);
  std::string all = "*NODE\n";
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    all += fmt::format("{}, {:.17g}, {:.17g}, {:.17g}\n", i + 1, mesh.X[i][0], mesh.X[i][1],
                       mesh.X[i][2]);
  }
  all += "*ELEMENT, TYPE=C3D4, ELSET=skin\n";
  std::map<std::set<int>, int> cells_of_face;
  for (std::size_t e = 0; e < cells.size(); ++e) {
    const Tetrahedron& t = cells[e];
    all += fmt::format("{}, {}, {}, {}, {}\n", e + 1, t[0] + 1, t[1] + 1, t[2] + 1, t[3] + 1);
    for (const auto& face : tetrahedron_faces) {
      ++cells_of_face[{t[face[0]], t[face[1]], t[face[2]]}];
    }
  }
  for (const auto& [name, nodes] : mesh.node_sets) {
    const std::set<int> in_set(nodes.begin(), nodes.end());
    std::string faces;
    for (std::size_t e = 0; e < cells.size(); ++e) {
      for (std::size_t f = 0; f < tetrahedron_faces.size(); ++f) {
        std::set<int> face;
        for (const int corner : tetrahedron_faces[f]) {
          face.insert(cells[e][corner]);
        }
        const bool inside = std::includes(in_set.begin(), in_set.end(), face.begin(), face.end());
        if (inside && cells_of_face[face] == 1) {
          faces += fmt::format("{}, S{}\n", e + 1, f + 1);
        }
      }
    }
    if (!faces.empty()) {
      all += fmt::format("*SURFACE, NAME={}, TYPE=ELEMENT\n{}", name, faces);
    }
  }
  return all;
}

// two columns to the left
std::string dedented(const std::string& text) {
  std::string all;
  for (std::size_t i = 0; i < text.size(); ++i) {
    all += text[i];
    if (text[i] == '\n' && text.compare(i + 1, 2, "  ") == 0) {
      i += 2;
    }
  }
  return all;
}

}  // namespace

std::string mesh_yaml(const Body& body) {
  std::string all = fmt::format("mesh:\n  geometry: {{{}}}\n", geometry_text(body));
  all += fmt::format("  cells: {}\n", body.cells);
  if (body.layers.size() > 1) {
    std::vector<std::string> layers;
    for (const Layer& layer : body.layers) {
      layers.push_back(
          fmt::format("{{name: {}, thickness: {:.17g}}}", layer.name, layer.thickness));
    }
    all += fmt::format("  bodies: [{}]\n", fmt::join(layers, ", "));
  }
  if (body.cut) {
    all += fmt::format("  cuts: [{{within: {}}}]\n", box_text(*body.cut));
  }
  if (!body.sets.empty()) {
    all += "  sets:\n";
    for (const BoxSet& set : body.sets) {
      all += fmt::format("    {}: {{within: {}}}\n", set.name, box_text(set));
    }
  }
  return all;
}

std::string inp_text(const Body& body) {
  Body hexahedra = body;
  hexahedra.cells = "hex8";
  const std::string solve_keys = "mesh:\n  ";
  const std::string yaml = mesh_yaml(hexahedra).substr(solve_keys.size());
  const MeshConfig config = read_config<MeshConfig>(parse_yaml(dedented(yaml), "mesh.yaml")).config;
  Mesh mesh = make_mesh(config, [](const std::string&) { return Place{}; }).mesh;
  for (Vec3& X : mesh.X) {
    X = body.turn * X;
  }
  // the sides are found again from the box around what was turned
  for (const std::string& side : side_names()) {
    mesh.node_sets.erase(side);
    mesh.facet_sets.erase(side);
  }
  if (body.cells == "tet15") {
    return tetrahedra_text(mesh);
  }
  return langer::inp_text(mesh);
}

std::string vector_text(const Vec3& v) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v[0], v[1], v[2]);
}

}  // namespace langer::relations
