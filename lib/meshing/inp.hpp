// Abaqus and CalculiX input files with those that *INCLUDE puts into them.
//
// What an .inp has becomes a mesh as exchange.hpp says. Three things have no counterpart there:
//   instances  of parts, moved and turned; a name that several instances have is instance.name
//   facets     element sets of plane elements, which Gmsh writes for its physical surfaces, and the
//              facets of the surface whose nodes all are in a node set, are facet sets too
//   reversed   cells whose nodes are numbered the other way round are turned, with a note
#pragma once

#include <string>
#include <vector>

#include "mechanics/mesh/mesh.hpp"
#include "meshing/inp_inclusion.hpp"

namespace langer {

// without an opener *INCLUDE is refused
Mesh parse_inp(const std::string& text, const std::string& shown_name,
               std::vector<std::string>& notes, const InpOpener& opener);

// Files that *INCLUDE puts into an .inp, in all depths, each once. Throws Failure(input).
std::vector<std::string> included_inp_files(const std::string& path);

}  // namespace langer
