// Rigid indenters as exact shapes. Positions are relative to the indenter: x - u_ind, with u_ind its displacement.
#pragma once

#include <variant>

#include "base/fields.hpp"
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
    const Vec3 n = vec(outward).normalized();
    return {n.dot(x - vec(point)), n, Mat3::Zero()};
  }
  std::vector<Complaint> complaints() const {
    if (vec(outward).norm() > 0) return {};
    return {{"normal", "[0, 0, 0]", "a direction", ""}};
  }
};

using Indenter = std::variant<Sphere, Plane, Cylinder, Ellipsoid, Facets>;

inline ShapePoint shape_at(const Indenter& shape, const Vec3& x) {
  return std::visit([&](const auto& s) { return s.at(x); }, shape);
}

}  // namespace langer
