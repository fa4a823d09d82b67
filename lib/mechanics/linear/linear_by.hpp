// How the linear systems of Newton's method are solved.
#pragma once

#include <array>

namespace langer {

// iterative: displacements and pressures together, by multigrid and GMRES (linear/mixed.hpp);
// automatic: iterative if the body is large and PETSc is available, else direct
enum class LinearBy { automatic, direct, iterative };
constexpr auto names(LinearBy) { return std::array{"auto", "direct", "iterative"}; }

}  // namespace langer
