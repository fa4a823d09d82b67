// The smallest box along the axes that holds some points.
#pragma once

#include <vector>

#include "tensor/types.hpp"

namespace langer {

struct Bounds {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  // [mm]
  Vec3 middle() const { return 0.5 * (low + high); }
  Vec3 size() const { return high - low; }
};

// X: at least one
inline Bounds bounds(const std::vector<Vec3>& X) {
  Bounds b{X.at(0), X.at(0)};
  for (const Vec3& x : X) b.low = b.low.cwiseMin(x), b.high = b.high.cwiseMax(x);
  return b;
}

}  // namespace langer
