// A plate without an end, with a round hole whose edge is rounded: exact distance, normal and curvature. A body is drawn into the hole.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/fields.hpp"
#include "contact/shape.hpp"

namespace langer {

struct Aperture {
  static constexpr const char* key = "aperture";
  double radius = 0, edge = 0;
  std::array<double, 3> face{}, into{0, 1, 0};
  static void fields(auto& v) {
    v(&Aperture::radius, "radius", unit::mm, "of the hole", required, positive);
    v(&Aperture::edge, "edge", unit::mm, "radius of the rounded edge: the plate is flat from radius + edge on", required, positive);
    v(&Aperture::face, "face", unit::mm, "centre of the hole in the plate's flat face, before it moves", required);
    v(&Aperture::into, "axis", unit::none, "direction from the face into the plate (any length)");
  }
  std::vector<Complaint> complaints() const {
    if (vec(into).stableNorm() > 0) return {};
    return {{"axis", "[0, 0, 0]", "a direction", ""}};
  }
  // the plate is a core (hole wider by the edge, starting one edge behind the face) thickened by the edge radius
  ShapePoint at(const Vec3& x) const {
    const Vec3 a = direction(into);
    auto [along, rho, outward] = about({vec(face), a}, x);
    if (rho == 0) outward = cross(a, Vec3::Unit(std::abs(a[0]) < 0.5 ? 0 : 1)).normalized();  // the whole wall is as near
    const double side = radius + edge - rho, end = edge - along;  // before the core sideways and endways
    if (side <= 0 && end <= 0) {                                  // inside the core: the nearer of end and side
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
  bool becomes(const Aperture& other, const Isometry& op) const {
    return radius == other.radius && edge == other.edge && goes_to(vec(face), vec(other.face), op) &&
           turns_to(direction(into), direction(other.into), op);
  }
  Outline outline(const Shown& shown) const;  // the wall, as high as the hole is wide, and the face as far as the picture goes
  double half_width() const { return std::numeric_limits<double>::infinity(); }
  std::optional<Vec3> inside() const { return std::nullopt; }
  std::optional<Line> axis() const { return Line{vec(face), direction(into)}; }
};

}  // namespace langer
