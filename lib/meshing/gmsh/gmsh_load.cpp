#include "meshing/gmsh/gmsh_load.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/base/error.hpp"
#include "core/base/module_path.hpp"
#include "core/base/traps.hpp"
#include "core/base/version.hpp"
#include "meshing/gmsh/child_process.hpp"
#include "meshing/gmsh/packed_model.hpp"

namespace langer {

namespace {

// The advice in its message is part of what is thrown: the words go through a pipe.
struct ModuleMissing : std::runtime_error {
  using std::runtime_error::runtime_error;
};

constexpr const char* missing = "gmsh, which such a file needs, ";

const gmsh_module::Functions& load_module() {
  // local: libgmsh has the same Eigen templates inside as we have, which allocate with another
  // alignment
  void* module = dlopen(module_path("gmsh").c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (!module) throw ModuleMissing(std::string(missing) + "cannot be loaded: " + dlerror());
  const auto* functions =
      static_cast<const gmsh_module::Functions*>(dlsym(module, gmsh_module::symbol));
  if (!functions || std::string(functions->made_with) != version)
    throw ModuleMissing(std::string(missing) + "is called by " + module_path("gmsh") +
                        ", which is of another version of Langer");
  return *functions;
}

// `call(functions)` makes the model, in the child. `file` is what the child finds as its input.
template <class Call>
MshModel call_in_child(const std::string& path, const std::string& file,
                       std::vector<std::string>& notes, int cpu_seconds, const Call& call) {
  const auto refuse = [&](const std::string& found, const std::string& hint) {
    throw Failure(Exit::input, Error{{path}, "", found, "", hint});
  };
  const gmsh_module::Functions* functions = nullptr;
  const ChildAnswer answer = run_in_child(
      file, [&] { functions = &load_module(); },
      [&](const std::string& input) {
        const NoTraps in_gmsh;  // it divides zero by zero where it lays out surfaces of triangles
        return packed(call(*functions, input));
      },
      cpu_seconds);
  if (!answer.is_restricted) {
    const std::string note =
        "this system cannot restrict what gmsh does (no seccomp): it reads a private copy of " +
        path + " in a separate process";
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
  }
  switch (answer.end) {
    case ChildEnd::not_prepared:
      if (answer.bytes.find("cannot be loaded") != std::string::npos)
        refuse(answer.bytes, "install libgmsh (Debian: libgmsh4.8) and Langer as a whole, with " +
                                 module_path("gmsh") + "; or give the mesh as .msh or .inp");
      refuse(answer.bytes, "build or install Langer as a whole");
      break;
    case ChildEnd::failed:
      refuse("gmsh cannot mesh it: " + answer.bytes, "");
      break;
    case ChildEnd::crashed:
      refuse("gmsh cannot mesh it: " + answer.bytes,
             "check the file in a CAD program, try another edge, or mesh it elsewhere and give the "
             "mesh as .msh or .inp");
      break;
    case ChildEnd::done:
      break;
  }
  MshModel model;
  try {
    model = unpacked(answer.bytes);
  } catch (const std::runtime_error& error) {
    refuse(std::string("gmsh cannot mesh it: ") + error.what(), "");
  }
  return model;
}

// CPU seconds after which meshing a closed surface is stopped. gmsh makes some ten thousand
// tetrahedra a second; a hundred times as long is an endless loop.
int meshing_seconds(const gmsh_module::Surface& surface, double edge) {
  std::array<double, 3> low{};
  std::array<double, 3> high{};
  for (std::size_t i = 0; i < surface.X.size(); ++i) {
    const std::size_t axis = i % 3;
    low[axis] = i < 3 ? surface.X[i] : std::min(low[axis], surface.X[i]);
    high[axis] = i < 3 ? surface.X[i] : std::max(high[axis], surface.X[i]);
  }
  const double box = (high[0] - low[0]) * (high[1] - low[1]) * (high[2] - low[2]);
  const double tetrahedra =
      8.5 * box / (edge * edge * edge) + static_cast<double>(surface.corners.size());
  return static_cast<int>(std::min<double>(longest_child, 20 + 0.01 * tetrahedra));
}

}  // namespace

MshModel mesh_surface_by_gmsh(const gmsh_module::Surface& surface,
                              const gmsh_module::SolidOrder& order, const std::string& path,
                              std::vector<std::string>& notes) {
  const auto mesh = [&](const auto& gmsh, const std::string&) {
    return gmsh.mesh_surface(surface, order);
  };
  return call_in_child(path, "", notes, meshing_seconds(surface, order.edge), mesh);
}

MshModel mesh_step_by_gmsh(const std::string& bytes, const gmsh_module::SolidOrder& order,
                           const std::string& path, std::vector<std::string>& notes) {
  const auto mesh = [&](const auto& gmsh, const std::string& input) {
    return gmsh.mesh_step(input, order);
  };
  return call_in_child(path, bytes, notes, longest_child, mesh);
}

}  // namespace langer
