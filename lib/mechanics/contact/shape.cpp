#include "mechanics/contact/shape.hpp"

#include <algorithm>
#include <cmath>

namespace langer {

Vec3 Isometry::operator()(const Vec3& x) const { return centre + turn * (x - centre); }

bool maps_point(const Vec3& x, const Vec3& y, const Isometry& op) {
  return (op(x) - y).norm() <= same_place * (1 + y.norm());
}

bool maps_direction(const Vec3& d, const Vec3& e, const Isometry& op) {
  return (op.turn * d - e).norm() <= same_place * e.norm();
}

Mat3 ring(const Vec3& a, const Vec3& outward, double n_rho, double rho) {
  if (!(rho > 0) || n_rho == 0) return Mat3::Zero();
  const Vec3 circle = cross(a, outward);
  return (n_rho / rho) * circle * circle.transpose();
}

ShapePoint round_edged(const RoundWall& at, double side, double end, double edge) {
  const double facing = static_cast<double>(at.wall);
  const Vec3 off = facing * at.outward;
  if (side <= 0 && end <= 0) {  // inside the core: the nearer of end and side
    if (end >= side) return {end - edge, -at.a, Mat3::Zero()};
    return {side - edge, off, ring(at.a, at.outward, facing, at.rho)};
  }
  const double s = std::max(side, 0.0);
  const double e = std::max(end, 0.0);
  const double distance = std::hypot(s, e);
  const Vec3 n = (s * off - e * at.a) / distance;
  Mat3 curvature = ring(at.a, at.outward, facing * s / distance, at.rho);
  if (s > 0 && e > 0) {  // on the rounded edge: curved along the meridian too
    const Vec3 meridian = (e * off + s * at.a) / distance;
    curvature += meridian * meridian.transpose() / distance;
  }
  return {distance - edge, n, curvature};
}

Mat3 tangent_projection(const Vec3& n) { return Mat3::Identity() - n * n.transpose(); }

Vec3 direction(const std::array<double, 3>& a) { return vec(a).stableNormalized(); }

}  // namespace langer
