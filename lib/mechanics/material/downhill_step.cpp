#include "mechanics/material/downhill_step.hpp"

namespace langer {

Vec2 downhill_step(const Vec2& g, const Mat2& H) {
  const PlanePrincipal eigen = principal(H);
  const Vec2 along = eigen.directions.transpose() * g;
  const Vec2 curvature = eigen.values.cwiseAbs().cwiseMax(5 * along.cwiseAbs());
  Vec2 step = Vec2::Zero();
  for (int i = 0; i < 2; ++i) {
    if (along[i] != 0) step[i] = -along[i] / curvature[i];
  }
  return eigen.directions * step;
}

}  // namespace langer
