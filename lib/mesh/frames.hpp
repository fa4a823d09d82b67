// The orthonormal frame of each cell, in which the fibres' angle is measured.                     [A23] eq. 1, section 4.4
//   global         the coordinate axes
//   element_edges  e_x along the cell's xi edges at its centre, e_y the part of its eta edges normal to e_x, e_z = e_x x e_y.
//                  On a mesh whose edges turn, so do the fibres: this is what gives fig. 17's kinks.
#pragma once

#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace langer {

enum class Frames { global, element_edges };
constexpr auto names(Frames) { return std::array{"global", "element_edges"}; }

std::vector<Mat3> frames(const Mesh& mesh, Frames kind);

}  // namespace langer
