#include "meshing/gmsh/gmsh_load.hpp"

#include <dlfcn.h>

#include <stdexcept>

#include "core/base/error.hpp"
#include "core/base/module_path.hpp"
#include "core/base/traps.hpp"
#include "core/base/version.hpp"

namespace langer {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& found,
                         const std::string& hint = "") {
  throw Failure(Exit::input, Error{{path}, "", found, "", hint});
}

const gmsh_module::Functions& module_for(const std::string& path) {
  static const gmsh_module::Functions* functions = nullptr;
  if (functions) return *functions;
  // local: libgmsh has the same Eigen templates inside as we have, which allocate with another
  // alignment
  void* module = dlopen(module_path("gmsh").c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (!module)
    refuse(path, std::string("gmsh, which such a file needs, cannot be loaded: ") + dlerror(),
           "install libgmsh (Debian: libgmsh4.8) and Langer as a whole, with " +
               module_path("gmsh") + "; or give the mesh as .inp");
  const auto* found =
      static_cast<const gmsh_module::Functions*>(dlsym(module, gmsh_module::symbol));
  if (!found || std::string(found->made_with) != version)
    refuse(path,
           "gmsh, which such a file needs, is called by " + module_path("gmsh") +
               ", which is of another version of Langer",
           "build or install Langer as a whole");
  return *(functions = found);
}

gmsh_module::Model asked(const std::string& path, const char* what, auto call) {
  const NoTraps in_gmsh;  // it divides zero by zero where it lays out surfaces of triangles
  const gmsh_module::Functions& gmsh = module_for(path);
  try {
    return call(gmsh);
  } catch (const std::runtime_error& words) {
    refuse(path, std::string("gmsh cannot ") + what + " it: " + words.what());
  }
}

}  // namespace

gmsh_module::Model read_by_gmsh(const std::string& path) {
  return asked(path, "read", [&](const auto& gmsh) { return gmsh.read(path); });
}

gmsh_module::Model mesh_by_gmsh(const std::string& path, const gmsh_module::SolidOrder& order) {
  return asked(path, "mesh", [&](const auto& gmsh) { return gmsh.solid(path, order); });
}

}  // namespace langer
