// How the dilatation of a cell enters its energy: element/solid.hpp says what each is.
#pragma once

#include <array>

#include "mechanics/mesh/mesh.hpp"

namespace langer {

enum class Formulation { mean_dilatation, displacement, linear_dilatation };
constexpr auto names(Formulation) {
  return std::array{"mean_dilatation", "displacement", "linear_dilatation"};
}
// what suits a cell: as many dilatations as its nodes can follow without locking
Formulation usual_formulation(CellType type);

}  // namespace langer
