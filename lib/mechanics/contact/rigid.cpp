#include "mechanics/contact/rigid.hpp"

#include <cmath>
#include <utility>

namespace langer {

ShapePoint Sphere::at(const Vec3& x) const {
  const Vec3 q = x - vec(centre);
  const double distance = q.norm();
  if (distance == 0) return {-radius, Vec3::UnitY(), Mat3::Zero()};
  const Vec3 n = q / distance;
  return {distance - radius, n, tangent_projection(n) / distance};
}

bool Sphere::maps_onto(const Sphere& other, const Isometry& op) const {
  return radius == other.radius && maps_point(vec(centre), vec(other.centre), op);
}

ShapePoint Plane::at(const Vec3& x) const {
  const Vec3 n = direction(outward);
  return {n.dot(x - vec(point)), n, Mat3::Zero()};
}

bool Plane::maps_onto(const Plane& other, const Isometry& op) const {
  const Vec3 p = vec(other.point);
  const Vec3 n = direction(other.outward);
  return maps_direction(direction(outward), n, op) &&
         std::abs(n.dot(op(vec(point)) - p)) <= same_place * (1 + p.norm());
}

std::vector<Complaint> Plane::complaints() const {
  if (vec(outward).stableNorm() > 0) return {};
  return {{"normal", "[0, 0, 0]", "a direction", ""}};
}

Outline Sphere::outline(const Shown& shown) const {
  return revolved(vec(centre), Vec3::UnitY(), half_circle(radius, shown.parts), 2 * shown.parts);
}

// a square about the middle of what is shown, and a net of lines
Outline Plane::outline(const Shown& shown) const {
  constexpr int n = 8;
  const Vec3 a = direction(outward);
  const Vec3 middle = shown.middle - at(shown.middle).gap * a;
  int least = 0;
  a.cwiseAbs().minCoeff(&least);
  const Vec3 s = shown.size / n * (Vec3::Unit(least) - a[least] * a).normalized();
  const Vec3 t = cross(a, s);
  Outline out;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      out.points.push_back(middle + (i - 0.5 * n) * s + (j - 0.5 * n) * t);
  const auto at_grid = [](int i, int j) {
    return i * (n + 1) + j;
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      out.faces.push_back(
          {at_grid(i, j), at_grid(i + 1, j), at_grid(i + 1, j + 1), at_grid(i, j + 1)});
  for (int i = 0; i <= n; ++i) {
    out.lines.push_back({at_grid(i, 0), at_grid(i, n)});
    out.lines.push_back({at_grid(0, i), at_grid(n, i)});
  }
  return out;
}

ShapePoint shape_at(const Indenter& shape, const Vec3& x) {
  return std::visit([&](const auto& s) { return s.at(x); }, shape);
}

bool maps_onto(const Indenter& shape, const Indenter& other, const Isometry& op) {
  return std::visit(
      [&]<class S>(const S& s) {
        const S* image = std::get_if<S>(&other);
        return image && s.maps_onto(*image, op);
      },
      shape);
}

bool unchanged_by(const Indenter& shape, const Isometry& op) { return maps_onto(shape, shape, op); }

// A shape that a rotation by one radian leaves unchanged is unchanged by every rotation: the
// multiples of one radian are dense on the circle.
bool is_revolved_about(const Line& line, const Indenter& shape) {
  return unchanged_by(shape, {rotation(line.along, 1), line.point});
}

std::optional<Line> axis_of(const Indenter& shape) {
  return std::visit([](const auto& s) { return s.axis(); }, shape);
}

Outline outline(const Indenter& shape, const Shown& shown) {
  return std::visit([&](const auto& s) { return s.outline(shown); }, shape);
}

double half_width(const Indenter& shape) {
  return std::visit([](const auto& s) { return s.half_width(); }, shape);
}

std::optional<Vec3> point_inside(const Indenter& shape) {
  return std::visit([](const auto& s) { return s.inside(); }, shape);
}

std::optional<RoundHole> hole_of(const Indenter& shape) {
  return std::visit(
      [](const auto& s) -> std::optional<RoundHole> {
        if constexpr (requires { s.hole(); }) return s.hole();
        return std::nullopt;
      },
      shape);
}

std::optional<Ball> ball_of(const Indenter& shape) {
  return std::visit(
      [](const auto& s) -> std::optional<Ball> {
        if constexpr (requires { s.ball(); }) return s.ball();
        return std::nullopt;
      },
      shape);
}

bool is_flat(const Indenter& shape) {
  return std::visit(
      [](const auto& s) {
        if constexpr (requires { s.is_flat; }) return s.is_flat;
        return false;
      },
      shape);
}

int force_order(const Indenter& shape) {
  return std::visit([](const auto& s) { return s.force_order; }, shape);
}

double edge_sharpness(const Indenter& shape) {
  return std::visit(
      [](const auto& s) {
        if constexpr (requires { s.edge_sharpness(); }) return s.edge_sharpness();
        return 1.0;
      },
      shape);
}

bool is_from_file(const Indenter& shape) { return surface_file(shape).has_value(); }

std::optional<std::string> surface_file(const Indenter& shape) {
  return std::visit(
      [](const auto& s) -> std::optional<std::string> {
        if constexpr (requires { s.surface_file(); }) return s.surface_file();
        return std::nullopt;
      },
      shape);
}

void set_file_triangles(Indenter& shape, Triangles in_file) {
  std::visit(
      [&](auto& s) {
        if constexpr (requires { s.set_file_triangles(in_file); })
          s.set_file_triangles(std::move(in_file));
      },
      shape);
}

void set_triangles(Indenter& shape, Triangles in_place) {
  std::visit(
      [&](auto& s) {
        if constexpr (requires { s.set_triangles(in_place); }) s.set_triangles(std::move(in_place));
      },
      shape);
}

const Triangles* triangles_of(const Indenter& shape) {
  return std::visit(
      [](const auto& s) -> const Triangles* {
        if constexpr (requires { s.triangles(); }) return s.triangles();
        return nullptr;
      },
      shape);
}

}  // namespace langer
