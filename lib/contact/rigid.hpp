// Rigid indenters as exact shapes: signed gap, outward normal and curvature at a point of space.
//   gap(x) > 0 outside the indenter; normal(x) points from the indenter to the body;
//   curvature [1/mm]: of the surfaces of constant gap through x, in every tangent direction (sphere) or 0 (plane).
// Positions are relative to the indenter: x - u_ind, with u_ind its displacement.
#pragma once

#include <variant>

#include "base/fields.hpp"
#include "tensor/types.hpp"

namespace langer {

struct Sphere {
  static constexpr const char* key = "sphere";
  double radius = 0;
  std::array<double, 3> centre{};
  static void fields(auto& v) {
    v(&Sphere::radius, "radius", unit::mm, "radius of the sphere", required, positive);
    v(&Sphere::centre, "centre", unit::mm, "centre before it moves", required);
  }
  Vec3 from_centre(const Vec3& x) const { return x - Vec3(centre[0], centre[1], centre[2]); }
  double gap(const Vec3& x) const { return from_centre(x).norm() - radius; }
  Vec3 normal(const Vec3& x) const { return from_centre(x).normalized(); }
  double curvature(const Vec3& x) const { return 1 / from_centre(x).norm(); }
};

struct Plane {
  static constexpr const char* key = "plane";
  std::array<double, 3> point{};
  std::array<double, 3> outward{};
  static void fields(auto& v) {
    v(&Plane::point, "point", unit::mm, "a point of the plane before it moves", required);
    v(&Plane::outward, "normal", unit::none, "direction from the plane to the body (any length)", required);
  }
  Vec3 normal(const Vec3&) const { return Vec3(outward[0], outward[1], outward[2]).normalized(); }
  double gap(const Vec3& x) const { return normal(x).dot(x - Vec3(point[0], point[1], point[2])); }
  double curvature(const Vec3&) const { return 0; }
  std::vector<Complaint> complaints() const {
    if (Vec3(outward[0], outward[1], outward[2]).norm() > 0) return {};
    return {{"normal", "[0, 0, 0]", "a direction", ""}};
  }
};

using Indenter = std::variant<Sphere, Plane>;

inline double gap(const Indenter& shape, const Vec3& x) {
  return std::visit([&](const auto& s) { return s.gap(x); }, shape);
}
inline Vec3 normal(const Indenter& shape, const Vec3& x) {
  return std::visit([&](const auto& s) { return s.normal(x); }, shape);
}
inline double curvature(const Indenter& shape, const Vec3& x) {
  return std::visit([&](const auto& s) { return s.curvature(x); }, shape);
}

}  // namespace langer
