// A vector of three values per node (3 n) as a list of vectors, as records of steps hold them.
#pragma once

#include <vector>

#include "core/tensor/types.hpp"

namespace langer {

inline std::vector<Vec3> by_node(const VecX& all) {
  std::vector<Vec3> out;
  for (Eigen::Index i = 0; i < all.size(); i += 3) out.push_back(all.segment<3>(i));
  return out;
}

}  // namespace langer
