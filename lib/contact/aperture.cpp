#include "contact/aperture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace langer {

std::vector<Complaint> Aperture::complaints() const {
  if (vec(into).stableNorm() > 0) return {};
  return {{"axis", "[0, 0, 0]", "a direction", ""}};
}

ShapePoint Aperture::at(const Vec3& x) const {
  const Vec3 a = direction(into);
  auto [along, rho, outward] = about({vec(face), a}, x);
  if (rho == 0) outward = cross(a, Vec3::Unit(std::abs(a[0]) < 0.5 ? 0 : 1)).normalized();  // the whole wall is as near
  const double side = radius + edge - rho, end = edge - along;                              // before the core sideways and endways
  if (side <= 0 && end <= 0) {  // inside the core: the nearer of end and side
    if (end >= side) return {end - edge, -a, Mat3::Zero()};
    return {side - edge, -outward, ring(a, outward, -1, rho)};
  }
  const double s = std::max(side, 0.0), e = std::max(end, 0.0), distance = std::hypot(s, e);
  const Vec3 n = (-s * outward - e * a) / distance;
  Mat3 curvature = ring(a, outward, -s / distance, rho);
  if (s > 0 && e > 0) {  // on the rounded edge: curved along the meridian too
    const Vec3 meridian = (e * outward - s * a) / distance;
    curvature += meridian * meridian.transpose() / distance;
  }
  return {distance - edge, n, curvature};
}

bool Aperture::becomes(const Aperture& other, const Isometry& op) const {
  return radius == other.radius && edge == other.edge && goes_to(vec(face), vec(other.face), op) &&
         turns_to(direction(into), direction(other.into), op);
}

Outline Aperture::outline(const Shown& shown) const {
  const int parts = shown.parts / 2;
  std::vector<std::array<double, 2>> profile;
  for (int i = 4; i > 0; --i) profile.push_back({edge + 0.5 * i * radius, radius});
  for (int i = 0; i <= parts; ++i) {
    const double theta = 0.5 * std::numbers::pi * i / parts;
    profile.push_back({edge * (1 - std::sin(theta)), radius + edge * (1 - std::cos(theta))});
  }
  const double flat = radius + edge, far = std::max(0.5 * shown.size, 1.5 * flat);
  for (int i = 1; i <= 4; ++i) profile.push_back({0, flat + 0.25 * i * (far - flat)});
  return revolved(vec(face), direction(into), profile, 2 * shown.parts, false);
}

}  // namespace langer
