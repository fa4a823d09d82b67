// Rigid indenters as exact shapes. Positions are relative to the indenter: x - u_ind, with u_ind its displacement.
#pragma once

#include <limits>
#include <variant>

#include "base/fields.hpp"
#include "contact/aperture.hpp"
#include "contact/facets.hpp"
#include "contact/punches.hpp"
#include "contact/shape.hpp"

namespace langer {

struct Sphere {
  static constexpr const char* key = "sphere";
  double radius = 0;
  std::array<double, 3> centre{};
  static void fields(auto& v) {
    v(&Sphere::radius, "radius", unit::mm, "radius of the sphere", required, positive);
    v(&Sphere::centre, "centre", unit::mm, "centre before it moves", required);
  }
  ShapePoint at(const Vec3& x) const {
    const Vec3 q = x - vec(centre);
    const double distance = q.norm();
    if (distance == 0) return {-radius, Vec3::UnitY(), Mat3::Zero()};
    const Vec3 n = q / distance;
    return {distance - radius, n, tangent_projection(n) / distance};
  }
  bool becomes(const Sphere& other, const Isometry& op) const {
    return radius == other.radius && goes_to(vec(centre), vec(other.centre), op);
  }
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
    v(&Plane::outward, "normal", unit::none, "direction from the plane to the body (any length)", required);
  }
  ShapePoint at(const Vec3& x) const {
    const Vec3 n = direction(outward);
    return {n.dot(x - vec(point)), n, Mat3::Zero()};
  }
  bool becomes(const Plane& other, const Isometry& op) const {
    const Vec3 p = vec(other.point), n = direction(other.outward);
    return turns_to(direction(outward), n, op) && std::abs(n.dot(op(vec(point)) - p)) <= same_place * (1 + p.norm());
  }
  Outline outline(const Shown& shown) const;
  double half_width() const { return std::numeric_limits<double>::infinity(); }
  std::optional<Vec3> inside() const { return std::nullopt; }
  std::optional<Line> axis() const { return Line{vec(point), direction(outward)}; }
  std::vector<Complaint> complaints() const {
    if (vec(outward).stableNorm() > 0) return {};
    return {{"normal", "[0, 0, 0]", "a direction", ""}};
  }
};

using Indenter = std::variant<Sphere, Plane, Cylinder, Ellipsoid, Aperture, Facets>;

template <class... S>
constexpr bool all_are_shapes(const std::variant<S...>*) {
  return (Shape<S> && ...);
}
static_assert(all_are_shapes(static_cast<const Indenter*>(nullptr)), "contact/shape.hpp says what a shape has to answer");

inline ShapePoint shape_at(const Indenter& shape, const Vec3& x) {
  return std::visit([&](const auto& s) { return s.at(x); }, shape);
}
inline bool becomes(const Indenter& shape, const Indenter& other, const Isometry& op) {
  return std::visit(
      [&]<class S>(const S& s) {
        const S* image = std::get_if<S>(&other);
        return image && s.becomes(*image, op);
      },
      shape);
}
inline bool unchanged_by(const Indenter& shape, const Isometry& op) { return becomes(shape, shape, op); }
// what stays as it is when turned by one radian does so for every turn: no multiple of it is a whole one
inline bool is_revolved_about(const Line& line, const Indenter& shape) {
  return unchanged_by(shape, {rotation(line.along, 1), line.point});
}
inline std::optional<Line> axis_of(const Indenter& shape) {
  return std::visit([](const auto& s) { return s.axis(); }, shape);
}
inline Outline outline(const Indenter& shape, const Shown& shown) {
  return std::visit([&](const auto& s) { return s.outline(shown); }, shape);
}
inline double half_width(const Indenter& shape) {
  return std::visit([](const auto& s) { return s.half_width(); }, shape);
}
inline std::optional<Vec3> point_inside(const Indenter& shape) {
  return std::visit([](const auto& s) { return s.inside(); }, shape);
}

}  // namespace langer
