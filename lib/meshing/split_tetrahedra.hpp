// Hexahedra from tetrahedra: each is split into four by the middles of its edges, its faces and
// itself. Edges stay straight, so that no hexahedron folds if no tetrahedron does, and the
// hexahedra fill the same space. Groups of triangles become groups of quadrilaterals, three for
// each.
#pragma once

#include "meshing/msh_model.hpp"

namespace langer {

// `model`: tetrahedra of four nodes and groups of triangles and volumes, as gmsh meshes a solid.
MshModel split_into_hexahedra(const MshModel& model);

}  // namespace langer
