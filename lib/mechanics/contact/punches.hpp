// A flat-ended cylinder with a rounded edge, and an ellipsoid: exact distance, normal and
// curvature.
#pragma once

#include "core/base/fields.hpp"
#include "mechanics/contact/shape.hpp"

namespace langer {

struct Cylinder {
  static constexpr const char* key = "cylinder";
  double radius = 0, edge = 0;
  std::array<double, 3> face{}, into{0, 1, 0};
  static void fields(auto& v) {
    v(&Cylinder::radius, "radius", unit::mm, "outer radius", required, positive);
    v(&Cylinder::edge, "edge", unit::mm, "radius of the rounded edge", required, positive);
    v(&Cylinder::face, "face", unit::mm, "centre of the flat end before it moves", required);
    v(&Cylinder::into, "axis", unit::none,
      "direction from the flat end into the cylinder (any length)");
  }
  std::vector<Complaint> complaints() const;
  // the cylinder is a core (radius less edge, starting one edge behind the face) thickened by the
  // edge radius
  ShapePoint at(const Vec3& x) const;
  bool maps_onto(const Cylinder& other, const Isometry& op) const;
  Outline outline(const Shown& shown) const;
  double half_width() const { return radius; }
  std::optional<Vec3> inside() const { return Vec3(vec(face) + edge * direction(into)); }
  std::optional<Line> axis() const { return Line{vec(face), direction(into)}; }
  static constexpr int force_order = 1;
  double edge_sharpness() const;
};

struct Ellipsoid {
  static constexpr const char* key = "ellipsoid";
  std::array<double, 3> half_axes{}, centre{};
  static void fields(auto& v) {
    v(&Ellipsoid::half_axes, "half_axes", unit::mm, "half axes along x, y, z", required, positive);
    v(&Ellipsoid::centre, "centre", unit::mm, "centre before it moves", required);
  }
  ShapePoint at(const Vec3& x) const;
  bool maps_onto(const Ellipsoid& other, const Isometry& op) const;
  Outline outline(const Shown& shown) const;
  double half_width() const;
  std::optional<Vec3> inside() const { return vec(centre); }
  // along the third half axis if the other two are equal; along y if all three are
  std::optional<Line> axis() const;
  static constexpr int force_order = 2;
};

}  // namespace langer
