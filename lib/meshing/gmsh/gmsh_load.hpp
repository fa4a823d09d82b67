// What gmsh makes of a file. The module with gmsh is loaded for the first of them, not with the
// program. Failure(input): gmsh's last words, or which library is missing and what to do.
#pragma once

#include <string>

#include "meshing/gmsh/gmsh_interface.hpp"

namespace langer {

gmsh_module::Model read_by_gmsh(const std::string& path);
gmsh_module::Model mesh_by_gmsh(const std::string& path, const gmsh_module::SolidOrder& order);

}  // namespace langer
