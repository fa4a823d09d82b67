// The orthonormal frame of each cell, in which the fibres' angle is measured. [A23] eq. 1,
// section 4.4
//   global         the coordinate axes
//   element_edges  as the cell's own numbering has it: e_x along its first edge (node 0 to 1, mean of the four xi edges), e_y the
//                  part of its second edge (node 0 to 3) normal to e_x, e_z = e_x x e_y. The block meshes number the second
//                  edge through the thickness, so that the angle is measured in the plane of the skin. Where the numbering
//                  turns from block to block, so do the fibres: this is what gives fig. 17's kinks.
//   file           those of the mesh file: e_x and e_z are the axes 1 and 2 of an *ORIENTATION, the coordinate axes without one
#pragma once

#include <array>
#include <vector>

#include "mechanics/mesh/mesh.hpp"

namespace langer {

enum class Frames { global, element_edges, file };
constexpr auto names(Frames) { return std::array{"global", "element_edges", "file"}; }

// Of kind file: mesh.frames, as the file gave them.
std::vector<Mat3> frames(const Mesh& mesh, Frames kind);

}  // namespace langer
