// Rigid indenters as exact shapes. Positions are relative to the indenter: x - u_ind, with u_ind
// its displacement.
#pragma once

#include <limits>
#include <variant>

#include "core/base/fields.hpp"
#include "mechanics/contact/aperture.hpp"
#include "mechanics/contact/facet_indenter.hpp"
#include "mechanics/contact/punches.hpp"
#include "mechanics/contact/shape.hpp"

namespace langer {

struct Sphere {
  static constexpr const char* key = "sphere";
  double radius = 0;
  std::array<double, 3> centre{};
  static void fields(auto& v) {
    v(&Sphere::radius, "radius", unit::mm, "radius of the sphere", required, positive);
    v(&Sphere::centre, "centre", unit::mm, "centre before it moves", required);
  }
  ShapePoint at(const Vec3& x) const;
  bool becomes(const Sphere& other, const Isometry& op) const;
  Outline outline(const Shown& shown) const;
  double half_width() const { return radius; }
  std::optional<Vec3> inside() const { return vec(centre); }
  std::optional<Line> axis() const { return Line{vec(centre), Vec3::UnitY()}; }
};

struct Plane {
  static constexpr const char* key = "plane";
  std::array<double, 3> point{};
  std::array<double, 3> outward{};
  static void fields(auto& v) {
    v(&Plane::point, "point", unit::mm, "a point of the plane before it moves", required);
    v(&Plane::outward, "normal", unit::none, "direction from the plane to the body (any length)",
      required);
  }
  ShapePoint at(const Vec3& x) const;
  bool becomes(const Plane& other, const Isometry& op) const;
  Outline outline(const Shown& shown) const;
  double half_width() const { return std::numeric_limits<double>::infinity(); }
  std::optional<Vec3> inside() const { return std::nullopt; }
  std::optional<Line> axis() const { return Line{vec(point), direction(outward)}; }
  std::vector<Complaint> complaints() const;
};

using Indenter = std::variant<Sphere, Plane, Cylinder, Ellipsoid, Aperture, Facets>;

template <class... S>
constexpr bool all_are_shapes(const std::variant<S...>*) {
  return (Shape<S> && ...);
}
static_assert(all_are_shapes(static_cast<const Indenter*>(nullptr)),
              "contact/shape.hpp says what a shape has to answer");

ShapePoint shape_at(const Indenter& shape, const Vec3& x);
bool becomes(const Indenter& shape, const Indenter& other, const Isometry& op);
bool unchanged_by(const Indenter& shape, const Isometry& op);
bool is_revolved_about(const Line& line, const Indenter& shape);
std::optional<Line> axis_of(const Indenter& shape);
Outline outline(const Indenter& shape, const Shown& shown);
double half_width(const Indenter& shape);
std::optional<Vec3> point_inside(const Indenter& shape);

}  // namespace langer
