// The paths of modules that a program loads only if a run needs them (gmsh, PETSc).
#pragma once

#include <filesystem>
#include <string>

namespace langer {

// next to the programs, both in the build folder and where they are installed
inline std::string module_path(const std::string& name) {
  const auto bin = std::filesystem::canonical("/proc/self/exe").parent_path();
  return (bin.parent_path() / ("lib/langer/langer_" + name + ".so")).string();
}

}  // namespace langer
