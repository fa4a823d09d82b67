// The border to gmsh: plain arrays over one function pointer each. gmsh brings 90 libraries, which
// take longer to load than many a scene to solve; they live in a module, lib/langer/langer_gmsh.so,
// that is loaded when a geometry needs it (gmsh_load.hpp), in a child process (child_process.hpp).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "meshing/msh_model.hpp"

namespace langer::gmsh_module {

// A surface of triangles that encloses a solid.
struct Surface {
  std::vector<double> X;             // three for each point
  std::vector<std::size_t> corners;  // points from 1, three for each triangle
};

// How a solid is meshed. gmsh puts the new nodes that a split of tetrahedra makes on the surface,
// which may fold a flat one; `straight` leaves them between the old ones.
struct SolidOrder {
  double edge = 1;  // [mm]
  bool hexahedra = true;
  bool straight = false;
};

// All throw std::runtime_error: gmsh's last words.
struct Functions {
  const char* made_with;  // version of the source; the program's own, or they do not fit together
  MshModel (*mesh_surface)(const Surface& surface, const SolidOrder& order);
  MshModel (*mesh_step)(const std::string& path, const SolidOrder& order);
};

inline constexpr const char* symbol = "langer_gmsh_module";  // const Functions, of C linkage

}  // namespace langer::gmsh_module
