// Reads a mesh of Gmsh: MSH 4.1, 4.0, 2.x and 1, as text, and 4.1 and 2.x as binary data (little
// endian, numbers of eight bytes).
//
// It keeps nodes, elements, physical groups and their names. Other sections ($Periodic, $NodeData,
// $Comments ...) are skipped. It never runs anything: a file that does not begin with a section of
// the format is refused, and so is every value that leads outside the file.
#pragma once

#include <string>
#include <string_view>

#include "meshing/msh_model.hpp"

namespace langer {

// Throws Failure(input), with the line of a text.
MshModel parse_msh(std::string_view bytes, const std::string& shown_name);

}  // namespace langer
