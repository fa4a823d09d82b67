// The folder of the running program, and the paths of modules that it loads only if a run needs
// them (gmsh, PETSc).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace langer {

// Also where another build has replaced the program's file since it was started: Linux then adds a
// remark to the name.
inline std::filesystem::path program_folder() {
  constexpr std::string_view replaced = " (deleted)";
  std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  if (program.ends_with(replaced)) program.resize(program.size() - replaced.size());
  return std::filesystem::path(program).parent_path();
}

// next to the programs, both in the build folder and where they are installed
inline std::string module_path(const std::string& name) {
  return (program_folder().parent_path() / ("lib/langer/langer_" + name + ".so")).string();
}

}  // namespace langer
