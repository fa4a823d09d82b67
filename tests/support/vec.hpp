// A vector from its numbers.
#pragma once

#include <initializer_list>

#include "core/tensor/types.hpp"

namespace langer::test {

inline VecX vec(std::initializer_list<double> x) {
  return Eigen::Map<const VecX>(x.begin(), static_cast<Eigen::Index>(x.size()));
}

}  // namespace langer::test
