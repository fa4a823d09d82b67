// Rigid indenters as exact shapes: the list of all shapes, and their answers whatever the shape.
// Positions are relative to the indenter: x - u_ind, with u_ind its displacement.
#pragma once

#include <limits>
#include <optional>
#include <string>
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
  bool maps_onto(const Sphere& other, const Isometry& op) const;
  Outline outline(const Shown& shown) const;
  double half_width() const { return radius; }
  std::optional<Vec3> inside() const { return vec(centre); }
  std::optional<Line> axis() const { return Line{vec(centre), Vec3::UnitY()}; }
  static constexpr int force_order = 2;
  std::optional<Ball> ball() const { return Ball{vec(centre), radius}; }
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
  bool maps_onto(const Plane& other, const Isometry& op) const;
  Outline outline(const Shown& shown) const;
  double half_width() const { return std::numeric_limits<double>::infinity(); }
  std::optional<Vec3> inside() const { return std::nullopt; }
  std::optional<Line> axis() const { return Line{vec(point), direction(outward)}; }
  static constexpr int force_order = 1;
  static constexpr bool is_flat = true;
  std::vector<Complaint> complaints() const;
};

using Indenter = std::variant<Sphere, Plane, Cylinder, Ellipsoid, Aperture, Facets>;

template <class... S>
constexpr bool all_are_shapes(const std::variant<S...>*) {
  return (Shape<S> && ...);
}
static_assert(all_are_shapes(static_cast<const Indenter*>(nullptr)),
              "contact/shape.hpp lists the members of a shape");

ShapePoint shape_at(const Indenter& shape, const Vec3& x);
bool maps_onto(const Indenter& shape, const Indenter& other, const Isometry& op);
bool unchanged_by(const Indenter& shape, const Isometry& op);
bool is_revolved_about(const Line& line, const Indenter& shape);

// Geometry
std::optional<Line> axis_of(const Indenter& shape);
Outline outline(const Indenter& shape, const Shown& shown);
double half_width(const Indenter& shape);
std::optional<Vec3> point_inside(const Indenter& shape);
std::optional<RoundHole> hole_of(const Indenter& shape);
std::optional<Ball> ball_of(const Indenter& shape);
bool is_flat(const Indenter& shape);

// Discretisation error: order of the force in the element size, and how many times shorter than
// the shape the rounding of its edge is (1: no such edge).
int force_order(const Indenter& shape);
double edge_sharpness(const Indenter& shape);

// Shapes whose surface comes from a file. The triangles are set after the configuration was read:
// as the file has them (then scaled and moved by the shape), or in the place of the indenter.
bool is_from_file(const Indenter& shape);
std::optional<std::string> surface_file(const Indenter& shape);
void set_file_triangles(Indenter& shape, Triangles in_file);
void set_triangles(Indenter& shape, Triangles in_place);
const Triangles* triangles_of(const Indenter& shape);

}  // namespace langer
