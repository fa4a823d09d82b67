#include "mechanics/solve/law_rows.hpp"

#include <algorithm>
#include <limits>

namespace langer {

LawRows law_rows(const CandidateState& state, double typical) {
  LawRows rows;
  const double mu = state.mu;
  if (state.status == ContactStatus::open) {
    rows.r = typical * Mat3::Identity();
    return rows;
  }
  rows.x(0, 0) = 1;
  if (mu == 0) {
    rows.r.bottomRightCorner<2, 2>() = typical * Eigen::Matrix2d::Identity();
  } else if (state.status == ContactStatus::stick) {
    rows.x.bottomRightCorner<2, 2>().setIdentity();
  } else {
    // r_t = -mu r_n s:  r_t' + mu r_n' s + mu r_n (1 - s s^T) x_t'/|x_t| = -mu' r_n s
    const Eigen::Vector2d s = -state.r.tail<2>().normalized();
    const double turning =
        mu * state.r[0] / std::max(state.slip, std::numeric_limits<double>::min());
    const double scale = 1 / (1 / typical + turning);
    rows.r.bottomRightCorner<2, 2>() = scale * Eigen::Matrix2d::Identity();
    rows.r.bottomLeftCorner<2, 1>() = scale * mu * s;
    rows.x.bottomRightCorner<2, 2>() =
        scale * turning * (Eigen::Matrix2d::Identity() - s * s.transpose());
  }
  return rows;
}

}  // namespace langer
