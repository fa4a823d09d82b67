// A plate without an end, with a round hole whose edge is rounded: exact distance, normal and
// curvature. A body is drawn into the hole.
#pragma once

#include <limits>

#include "core/base/fields.hpp"
#include "mechanics/contact/shape.hpp"

namespace langer {

struct Aperture {
  static constexpr const char* key = "aperture";
  double radius = 0, edge = 0;
  std::array<double, 3> face{}, into{0, 1, 0};
  static void fields(auto& v) {
    v(&Aperture::radius, "radius", unit::mm, "of the hole", required, positive);
    v(&Aperture::edge, "edge", unit::mm,
      "radius of the rounded edge: the plate is flat from radius + edge on", required, positive);
    v(&Aperture::face, "face", unit::mm,
      "centre of the hole in the plate's flat face, before it moves", required);
    v(&Aperture::into, "axis", unit::none, "direction from the face into the plate (any length)");
  }
  std::vector<Complaint> complaints() const;
  // the plate is a core (hole wider by the edge, starting one edge behind the face) thickened by
  // the edge radius
  ShapePoint at(const Vec3& x) const;
  bool maps_onto(const Aperture& other, const Isometry& op) const;
  Outline outline(const Shown& shown)
      const;  // the wall, as high as the hole is wide, and the face as far as the picture goes
  double half_width() const { return std::numeric_limits<double>::infinity(); }
  std::optional<Vec3> inside() const { return std::nullopt; }
  std::optional<Line> axis() const { return Line{vec(face), direction(into)}; }
  static constexpr int force_order = 1;
  std::optional<RoundHole> hole() const { return RoundHole{*axis(), radius, edge}; }
};

}  // namespace langer
