// The border to gmsh: plain arrays over one function pointer each. gmsh brings 90 libraries, which
// take longer to load than many a scene to solve; they live in a module, lib/langer/langer_gmsh.so,
// that is loaded when a geometry needs it (load.hpp). Types of elements are those of the MSH
// format; of first order its nodes stand as VTK's do.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace langer::gmsh_module {

inline constexpr int triangle = 2, quadrangle = 3, tetrahedron = 4, hexahedron = 5, point = 15;

struct Elements {  // of one type
  int type = 0;
  std::string name;  // of the type, e.g. "Pyramid 5"
  std::vector<std::size_t> tags, nodes;
};

struct Group {  // a physical group
  int dim = 0, tag = 0;
  std::string name;                // may be empty
  std::vector<Elements> elements;  // of dim 2 and 3
  std::vector<std::size_t> nodes;  // of dim 0 and 1, by tag
};

struct Model {
  bool has_volumes = true;
  std::vector<std::size_t> node_tags;
  std::vector<double> X;  // three for each node
  std::vector<Elements> cells;
  std::vector<Group> groups;
};

// How a solid is meshed. gmsh puts the new nodes that a split of tetrahedra makes on the surface,
// which may fold a flat one; `straight` leaves them between the old ones.
struct SolidOrder {
  bool facets = false;  // triangles (.stl) that enclose it, else a .step
  double edge = 1;      // [mm]
  bool hexahedra = true, straight = false;
};

// Both throw std::runtime_error: gmsh's last words.
struct Functions {
  const char* made_with;  // version of the source; the program's own, or they do not fit together
  Model (*read)(const std::string& path);                            // a .msh of any version
  Model (*solid)(const std::string& path, const SolidOrder& order);  // meshed
};

inline constexpr const char* symbol = "langer_gmsh_module";  // const Functions, of C linkage

}  // namespace langer::gmsh_module
