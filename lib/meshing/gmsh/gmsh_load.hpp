// Meshes that gmsh makes. The module with gmsh is loaded in a child process that can read and
// compute, but not start a program, open a connection or write a file (child_process.hpp).
// Failure(input): gmsh's last words, that it crashed, or which library is missing and what to do.
#pragma once

#include <string>
#include <vector>

#include "meshing/gmsh/gmsh_interface.hpp"

namespace langer {

// `path` is the file's name in messages, `bytes` a STEP file; `notes` says when the kernel cannot
// restrict the child.
MshModel mesh_surface_by_gmsh(const gmsh_module::Surface& surface,
                              const gmsh_module::SolidOrder& order, const std::string& path,
                              std::vector<std::string>& notes);
MshModel mesh_step_by_gmsh(const std::string& bytes, const gmsh_module::SolidOrder& order,
                           const std::string& path, std::vector<std::string>& notes);

}  // namespace langer
