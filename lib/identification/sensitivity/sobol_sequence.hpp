// Sobol' low-discrepancy sequence [S67] with the direction numbers of Joe and Kuo [JK08], by
// Boost.Random; up to 3667 dimensions. A digital shift makes each sequence random and keeps what it
// is good for: of its first 2^k points each of 2^k equal parts of every axis holds one.
#pragma once

#include <memory>
#include <vector>

#include "core/base/random.hpp"
#include "core/tensor/types.hpp"

namespace langer {

class SobolSequence {
 public:
  static constexpr Eigen::Index most_dimensions = 3667;
  SobolSequence(Eigen::Index dimensions, Random shift,
                std::uint32_t from = 0);  // the first point that is given
  ~SobolSequence();
  VecX next();  // in (0, 1)

 private:
  struct Engine;
  std::unique_ptr<Engine> engine_;
  std::vector<std::uint32_t> shift_, point_;
  bool begun_ = false;
};

}  // namespace langer
