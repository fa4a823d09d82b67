// The directions of fibre families in a frame of their own: the first axis is the first family, and
// the second family is in the plane of the first two axes. Several programs take directions only in
// such a frame.
#pragma once

#include <vector>

#include "core/tensor/types.hpp"

namespace langer {

struct FibreFrame {
  Vec3 e1, e2;                 // orthonormal; the third is e1 x e2
  std::vector<Vec3> in_frame;  // components of each family's direction
};
FibreFrame fibre_frame(const std::vector<Vec3>& fibres);

}  // namespace langer
