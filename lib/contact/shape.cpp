#include "contact/shape.hpp"

namespace langer {

Vec3 Isometry::operator()(const Vec3& x) const { return centre + turn * (x - centre); }

bool goes_to(const Vec3& x, const Vec3& y, const Isometry& op) { return (op(x) - y).norm() <= same_place * (1 + y.norm()); }

bool turns_to(const Vec3& d, const Vec3& e, const Isometry& op) { return (op.turn * d - e).norm() <= same_place * e.norm(); }

Mat3 ring(const Vec3& a, const Vec3& outward, double n_rho, double rho) {
  if (!(rho > 0) || n_rho == 0) return Mat3::Zero();
  const Vec3 circle = cross(a, outward);
  return (n_rho / rho) * circle * circle.transpose();
}

Mat3 tangent_projection(const Vec3& n) { return Mat3::Identity() - n * n.transpose(); }

Vec3 direction(const std::array<double, 3>& a) { return vec(a).stableNormalized(); }

}  // namespace langer
