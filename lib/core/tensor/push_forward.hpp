// Moduli of the reference configuration as moduli of the current one.
#pragma once

#include "core/tensor/types.hpp"

namespace langer {

// [BW08]  c_ijkl = F_iI F_jJ F_kK F_lL D_IJKL / J, components in the order of voigt.hpp [MPa]
// D has engineering strains on both sides.
Mat6 push_forward(const Mat3& F, const Mat6& D, double J);

}  // namespace langer
