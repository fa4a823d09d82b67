// Stability of a body from its cells, without a factor of its tangent.
//
// The tangent of a body is the sum of the tangents of its cells. Where none of these has a negative
// eigenvalue the sum has none either, and a body that its supports hold is stable. The condition is
// sufficient and not necessary: a cell under compression gives way where it is turned, though its
// neighbours hold it. Then only a factor shows the signs of the whole tangent.
//
// Cells that deform alike have the same tangent, so a homogeneous body costs a few cells.
#pragma once

#include "mechanics/assembly/assembler.hpp"

namespace langer {

// Whether no cell has a negative eigenvalue at the displacements u (3 n), of an elastic body
// without pressures. False also where this is not known: a viscous body, loads that follow the
// surface, or cells of linear_dilatation.
bool every_cell_resists(const Assembler& body, const VecX& u);

}  // namespace langer
