// Where the modules lie that a program loads when it needs what they bring (gmsh, PETSc).
#pragma once

#include <filesystem>
#include <string>

namespace langer {

// beside the programs, in the build folder as where they are installed
inline std::string module_path(const std::string& name) {
  const auto bin = std::filesystem::canonical("/proc/self/exe").parent_path();
  return (bin.parent_path() / ("lib/langer/langer_" + name + ".so")).string();
}

}  // namespace langer
