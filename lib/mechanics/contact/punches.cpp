#include "mechanics/contact/punches.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace langer {

std::vector<Complaint> Cylinder::complaints() const {
  std::vector<Complaint> found;
  if (edge > radius) found.push_back({"edge", "larger than the radius", "edge <= radius", ""});
  if (!(vec(into).stableNorm() > 0)) found.push_back({"axis", "[0, 0, 0]", "a direction", ""});
  return found;
}

ShapePoint Cylinder::at(const Vec3& x) const {
  const Vec3 a = direction(into);
  const auto [along, rho, outward] = about({vec(face), a}, x);
  // beyond the core sideways and endways
  const double side = rho - (radius - edge);
  const double end = edge - along;
  return round_edged({a, outward, rho, Wall::faces_away}, side, end, edge);
}

bool Cylinder::maps_onto(const Cylinder& other, const Isometry& op) const {
  return radius == other.radius && edge == other.edge &&
         maps_point(vec(face), vec(other.face), op) &&
         maps_direction(direction(into), direction(other.into), op);
}

// A cylinder that was never read from a configuration may have no rounding.
double Cylinder::edge_sharpness() const {
  if (!(edge > 0)) return 1;
  return std::max(1.0, radius / edge);
}

// from its flat end as far as it is wide
Outline Cylinder::outline(const Shown& shown) const {
  std::vector<std::array<double, 2>> profile{{0, 0}};
  for (int i = 0; i <= shown.parts / 2; ++i) {
    const double theta = 0.5 * std::numbers::pi * i / (shown.parts / 2);
    profile.push_back({edge * (1 - std::cos(theta)), radius - edge * (1 - std::sin(theta))});
  }
  if (profile[1][1] <= 0) profile.erase(profile.begin());  // no flat part is left
  for (int i = 1; i <= 4; ++i) profile.push_back({edge + 0.5 * i * radius, radius});
  return revolved(vec(face), direction(into), profile, 2 * shown.parts);
}

namespace {

// The nearest point of an ellipsoid: c_i = h_i^2 q_i / (t + h_i^2), with t the largest root of
//   sum (h_i q_i / (t + h_i^2))^2 = 1
Vec3 nearest(Vec3 q, const Vec3& h) {
  const double tiny = 1e-12 * h.minCoeff();
  for (double& v : q) {
    // off the planes of symmetry: one nearest point
    if (std::abs(v) < tiny) {
      v = std::copysign(tiny, v);
    }
  }
  const Vec3 hh = h.cwiseProduct(h);
  int least = 0;
  h.minCoeff(&least);
  const Vec3 hq = h.cwiseProduct(q);
  const auto f = [&](double t) {
    return hq.cwiseQuotient(hh + Vec3::Constant(t)).squaredNorm() - 1;
  };
  double low = -hh.minCoeff() + h.minCoeff() * std::abs(q[least]);
  double high = h.maxCoeff() * q.norm();
  if (f(low) < 0) low = -hh.minCoeff();
  double t = std::clamp(0.0, low, high);
  for (int k = 0; k < 200; ++k) {  // Newton kept inside a shrinking bracket; f falls and is convex
    const Vec3 from = hh + Vec3::Constant(t);
    const Vec3 part = hq.cwiseQuotient(from).cwiseAbs2();
    const double value = part.sum() - 1;
    if (value > 0)
      low = t;
    else
      high = t;
    double next = t + 0.5 * value / part.cwiseQuotient(from).sum();
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == t || high - low <= 1e-16 * hh.maxCoeff()) break;
    t = next;
  }
  Vec3 c;
  for (int i = 0; i < 3; ++i) c[i] = hh[i] * q[i] / (t + hh[i]);
  return c;
}

}  // namespace

ShapePoint Ellipsoid::at(const Vec3& x) const {
  const Vec3 h = vec(half_axes);
  const Vec3 q = x - vec(centre);
  const Vec3 c = nearest(q, h);
  const Vec3 slope = 2 * c.cwiseQuotient(h.cwiseProduct(h));  // gradient of sum (c_i/h_i)^2
  ShapePoint p;
  p.normal = slope.normalized();
  p.gap = (q - c).dot(p.normal);
  // shape operator S of the surface at c, carried to the surface of constant gap: S (1 + gap S)^-1
  const Mat3 P = tangent_projection(p.normal);
  const Mat3 S = P * Mat3((2 * h.cwiseProduct(h).cwiseInverse()).asDiagonal()) * P / slope.norm();
  p.curvature = S * Mat3(Mat3::Identity() + p.gap * S).inverse();
  return p;
}

bool Ellipsoid::maps_onto(const Ellipsoid& other, const Isometry& op) const {
  const Mat3 H = vec(half_axes).cwiseProduct(vec(half_axes)).asDiagonal();
  const Mat3 image = vec(other.half_axes).cwiseProduct(vec(other.half_axes)).asDiagonal();
  return maps_point(vec(centre), vec(other.centre), op) &&
         (op.turn * H * op.turn.transpose() - image).norm() <= same_place * image.norm();
}

double Ellipsoid::half_width() const {
  std::array<double, 3> h = half_axes;
  std::sort(h.begin(), h.end());
  return h[1];
}

std::optional<Line> Ellipsoid::axis() const {
  for (int k : {1, 0, 2})
    if (half_axes[(k + 1) % 3] == half_axes[(k + 2) % 3]) return Line{vec(centre), Vec3::Unit(k)};
  return std::nullopt;
}

Outline Ellipsoid::outline(const Shown& shown) const {
  Outline out = revolved(Vec3::Zero(), Vec3::UnitY(), half_circle(1, shown.parts), 2 * shown.parts);
  for (Vec3& x : out.points) x = vec(centre) + vec(half_axes).cwiseProduct(x);
  return out;
}

}  // namespace langer
