// A flat-ended cylinder with a rounded edge, and an ellipsoid: exact distance, normal and curvature.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/fields.hpp"
#include "contact/shape.hpp"

namespace langer {

struct Cylinder {
  static constexpr const char* key = "cylinder";
  double radius = 0, edge = 0;
  std::array<double, 3> face{}, into{0, 1, 0};
  static void fields(auto& v) {
    v(&Cylinder::radius, "radius", unit::mm, "outer radius", required, positive);
    v(&Cylinder::edge, "edge", unit::mm, "radius of the rounded edge", required, positive);
    v(&Cylinder::face, "face", unit::mm, "centre of the flat end before it moves", required);
    v(&Cylinder::into, "axis", unit::none, "direction from the flat end into the cylinder (any length)");
  }
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> found;
    if (edge > radius) found.push_back({"edge", "larger than the radius", "edge <= radius", ""});
    if (!(vec(into).stableNorm() > 0)) found.push_back({"axis", "[0, 0, 0]", "a direction", ""});
    return found;
  }
  // the cylinder is a core (radius less edge, starting one edge behind the face) thickened by the edge radius
  ShapePoint at(const Vec3& x) const {
    const Vec3 a = direction(into);
    const auto [along, rho, outward] = about({vec(face), a}, x);
    const double side = rho - (radius - edge), end = edge - along;  // beyond the core sideways and endways
    if (side <= 0 && end <= 0) {                                    // inside the core: the nearer of end and side
      if (end >= side) return {end - edge, -a, Mat3::Zero()};
      return {side - edge, outward, ring(a, outward, 1, rho)};
    }
    const double s = std::max(side, 0.0), e = std::max(end, 0.0), distance = std::hypot(s, e);
    const Vec3 n = (s * outward - e * a) / distance;
    Mat3 curvature = ring(a, outward, s / distance, rho);
    if (s > 0 && e > 0) {  // on the rounded edge: curved along the meridian too
      const Vec3 meridian = (e * outward + s * a) / distance;
      curvature += meridian * meridian.transpose() / distance;
    }
    return {distance - edge, n, curvature};
  }
  bool becomes(const Cylinder& other, const Isometry& op) const {
    return radius == other.radius && edge == other.edge && goes_to(vec(face), vec(other.face), op) &&
           turns_to(direction(into), direction(other.into), op);
  }
  Outline outline(const Shown& shown) const;
  double half_width() const { return radius; }
  std::optional<Vec3> inside() const { return Vec3(vec(face) + edge * direction(into)); }
  std::optional<Line> axis() const { return Line{vec(face), direction(into)}; }
};

struct Ellipsoid {
  static constexpr const char* key = "ellipsoid";
  std::array<double, 3> half_axes{}, centre{};
  static void fields(auto& v) {
    v(&Ellipsoid::half_axes, "half_axes", unit::mm, "half axes along x, y, z", required, positive);
    v(&Ellipsoid::centre, "centre", unit::mm, "centre before it moves", required);
  }
  ShapePoint at(const Vec3& x) const {
    const Vec3 h = vec(half_axes), q = x - vec(centre);
    const Vec3 c = nearest(q, h);
    const Vec3 slope = 2 * c.cwiseQuotient(h.cwiseProduct(h));  // gradient of sum (c_i/h_i)^2
    ShapePoint p;
    p.normal = slope.normalized();
    p.gap = (q - c).dot(p.normal);
    // shape operator S of the surface at c, carried to the surface of constant gap: S (1 + gap S)^-1
    const Mat3 P = tangent_projection(p.normal);
    const Mat3 S = P * Mat3((2 * h.cwiseProduct(h).cwiseInverse()).asDiagonal()) * P / slope.norm();
    p.curvature = S * inverse(Mat3::Identity() + p.gap * S);
    return p;
  }
  bool becomes(const Ellipsoid& other, const Isometry& op) const {
    const Mat3 H = vec(half_axes).cwiseProduct(vec(half_axes)).asDiagonal(),
               image = vec(other.half_axes).cwiseProduct(vec(other.half_axes)).asDiagonal();
    return goes_to(vec(centre), vec(other.centre), op) &&
           (op.turn * H * op.turn.transpose() - image).norm() <= same_place * image.norm();
  }
  Outline outline(const Shown& shown) const;
  double half_width() const {
    std::array<double, 3> h = half_axes;
    std::sort(h.begin(), h.end());
    return h[1];
  }
  std::optional<Vec3> inside() const { return vec(centre); }
  // where two half axes are equal: along the third; of a sphere along y
  std::optional<Line> axis() const {
    for (int k : {1, 0, 2})
      if (half_axes[(k + 1) % 3] == half_axes[(k + 2) % 3]) return Line{vec(centre), Vec3::Unit(k)};
    return std::nullopt;
  }

 private:
  // nearest point c_i = h_i^2 q_i / (t + h_i^2) with t the largest root of sum (h_i q_i / (t + h_i^2))^2 = 1
  static Vec3 nearest(Vec3 q, const Vec3& h) {
    const double tiny = 1e-12 * h.minCoeff();
    for (double& v : q) v = std::abs(v) < tiny ? std::copysign(tiny, v) : v;  // off the planes of symmetry: one nearest point
    const Vec3 hh = h.cwiseProduct(h);
    const auto f = [&](double t) {
      double sum = -1;
      for (int i = 0; i < 3; ++i) sum += std::pow(h[i] * q[i] / (t + hh[i]), 2);
      return sum;
    };
    double low = -hh.minCoeff() + h.minCoeff() * std::abs(q[smallest(h)]), high = h.maxCoeff() * q.norm();
    if (f(low) < 0) low = -hh.minCoeff();
    double t = std::clamp(0.0, low, high);
    for (int k = 0; k < 200; ++k) {  // Newton kept inside a shrinking bracket; f falls and is convex
      const double value = f(t);
      (value > 0 ? low : high) = t;
      double slope = 0;
      for (int i = 0; i < 3; ++i) slope -= 2 * std::pow(h[i] * q[i], 2) / std::pow(t + hh[i], 3);
      double next = t - value / slope;
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      if (next == t || high - low <= 1e-16 * hh.maxCoeff()) break;
      t = next;
    }
    Vec3 c;
    for (int i = 0; i < 3; ++i) c[i] = hh[i] * q[i] / (t + hh[i]);
    return c;
  }
  static int smallest(const Vec3& h) { return h[0] <= h[1] && h[0] <= h[2] ? 0 : h[1] <= h[2] ? 1 : 2; }
  static Mat3 inverse(const Mat3& A);
};

}  // namespace langer
