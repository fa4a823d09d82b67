// The smallest box along the axes that holds some points.
#pragma once

#include <vector>

#include "core/tensor/types.hpp"

namespace langer {

struct BoundingBox {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  // [mm]
  Vec3 middle() const { return 0.5 * (low + high); }
  Vec3 size() const { return high - low; }
};

// X: at least one
inline BoundingBox bounding_box(const std::vector<Vec3>& X) {
  BoundingBox b{X.at(0), X.at(0)};
  for (const Vec3& x : X) {
    b.low = b.low.cwiseMin(x);
    b.high = b.high.cwiseMax(x);
  }
  return b;
}

}  // namespace langer
