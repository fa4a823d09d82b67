#include "mechanics/contact/aperture.hpp"

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
  // On the axis, up to rounding, every direction across it is as good.
  if (rho <= 1e-12 * std::abs(along))
    outward = cross(a, Vec3::Unit(std::abs(a[0]) < 0.5 ? 0 : 1))
                  .normalized();  // the whole wall is as near
  // before the core sideways and endways
  const double side = radius + edge - rho;
  const double end = edge - along;
  return round_edged({a, outward, rho, Wall::faces_axis}, side, end, edge);
}

bool Aperture::maps_onto(const Aperture& other, const Isometry& op) const {
  return radius == other.radius && edge == other.edge &&
         maps_point(vec(face), vec(other.face), op) &&
         maps_direction(direction(into), direction(other.into), op);
}

Outline Aperture::outline(const Shown& shown) const {
  const int parts = shown.parts / 2;
  std::vector<std::array<double, 2>> profile;
  for (int i = 4; i > 0; --i) profile.push_back({edge + 0.5 * i * radius, radius});
  for (int i = 0; i <= parts; ++i) {
    const double theta = 0.5 * std::numbers::pi * i / parts;
    profile.push_back({edge * (1 - std::sin(theta)), radius + edge * (1 - std::cos(theta))});
  }
  const double flat = radius + edge;
  const double far = std::max(0.5 * shown.size, 1.5 * flat);
  for (int i = 1; i <= 4; ++i) profile.push_back({0, flat + 0.25 * i * (far - flat)});
  return revolved(vec(face), direction(into), profile, 2 * shown.parts, false);
}

}  // namespace langer
