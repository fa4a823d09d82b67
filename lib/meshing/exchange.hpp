// Meshes of other programs: Gmsh (.msh, MSH 1, 2 and 4, text or binary; written as 4.1) and Abaqus
// or CalculiX (.inp). .msh: 8-node hexahedra, or 4-node tetrahedra that become tet15; .inp: those,
// hexahedra of 20 and 27 nodes, which become hex27, and 10-node tetrahedra, with their curved edges
// (ReferenceCell::names). What has a name there has it here:
//   bodies      .msh: physical volumes; .inp: element sets of *SOLID SECTION, without any those of *ELEMENT
//   facet sets  .msh: physical surfaces; .inp: *SURFACE of elements; their nodes are a node set of the same name
//   node sets   .msh: physical points and curves too; .inp: *NSET, *SURFACE of nodes, and the new nodes between theirs
//               (mesh/raise.hpp)
// Nodes and cells keep the file's order; nodes that no cell has are left out. Reading fails as
// Failure(input) with the line of a text.
#pragma once

#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "mechanics/mesh/mesh.hpp"

namespace langer {

// Names of sets and bodies become parts of keys and of HDF5 paths: '_' in place of blanks, dots and
// slashes, which would split those.
std::string usable_name(std::string name);

enum class MeshFormat { msh, inp };
constexpr auto names(MeshFormat) { return std::array{"msh", "inp"}; }

// X, connectivity, body and bodies (one of no name where the file names none), sets; no frames.
// `notes`: what was left out.
Mesh read_msh(const std::string& path, std::vector<std::string>& notes);
Mesh read_inp(const std::string& path, std::vector<std::string>& notes);
struct SolidOptions {
  bool is_surface = false;  // triangles (STL) that enclose it, else CAD (STEP)
  double edge = 1;          // length of the cells, about
  CellType cells = CellType::hex8;
  double seal = 0;   // width up to which holes of a surface are filled
  double scale = 1;  // mm per unit of the file, for messages
};
// A solid meshed by gmsh, lengths in units of the file: face_<n> are its faces, body_<n> its bodies
// where there are several. A surface that stays open is refused; `notes` states what was filled and
// the volume that straight edges cut off.
Mesh read_solid(const std::string& path, const SolidOptions& options,
                std::vector<std::string>& notes);
Mesh parse_inp(const std::string& text, const std::string& shown_name,
               std::vector<std::string>& notes);

// Bodies and sets as above; a node set that is no more than the nodes of the facet set of its name
// is not written twice. hex8 only (names.abaqus.written). Failure(config) for a name that the
// format cannot hold.
std::string msh_text(const Mesh& mesh);
std::string inp_text(const Mesh& mesh);

std::vector<int> nodes_of(const Mesh& mesh, const std::vector<Facet>& facets);  // ascending
// as a facet set, and its nodes as a node set
void name_facets(Mesh& mesh, const std::string& name, const std::vector<Facet>& facets);

}  // namespace langer
