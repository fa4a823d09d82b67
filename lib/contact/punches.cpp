#include "contact/punches.hpp"

#include <Eigen/LU>
#include <numbers>

#include "contact/rigid.hpp"

namespace langer {

namespace {

// half a circle about 0, from along = -radius
std::vector<std::array<double, 2>> half_circle(double radius, int parts) {
  std::vector<std::array<double, 2>> profile;
  for (int i = 0; i <= parts; ++i) {
    const double theta = std::numbers::pi * i / parts;
    profile.push_back({-radius * std::cos(theta), i % parts == 0 ? 0 : radius * std::sin(theta)});
  }
  return profile;
}

}  // namespace

Outline Sphere::outline(const Shown& shown) const {
  return revolved(vec(centre), Vec3::UnitY(), half_circle(radius, shown.parts), 2 * shown.parts);
}

// a square about the middle of what is shown, and a net of lines
Outline Plane::outline(const Shown& shown) const {
  constexpr int n = 8;
  const Vec3 a = direction(outward), middle = shown.middle - at(shown.middle).gap * a;
  int least = 0;
  a.cwiseAbs().minCoeff(&least);
  const Vec3 s = shown.size / n * (Vec3::Unit(least) - a[least] * a).normalized();
  const Vec3 t = cross(a, s);
  Outline out;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) out.points.push_back(middle + (i - 0.5 * n) * s + (j - 0.5 * n) * t);
  const auto at_grid = [](int i, int j) { return i * (n + 1) + j; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) out.faces.push_back({at_grid(i, j), at_grid(i + 1, j), at_grid(i + 1, j + 1), at_grid(i, j + 1)});
  for (int i = 0; i <= n; ++i)
    out.lines.push_back({at_grid(i, 0), at_grid(i, n)}), out.lines.push_back({at_grid(0, i), at_grid(n, i)});
  return out;
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

Outline Aperture::outline(const Shown& shown) const {
  const int parts = shown.parts / 2;
  std::vector<std::array<double, 2>> profile;
  for (int i = 4; i > 0; --i) profile.push_back({edge + 0.5 * i * radius, radius});
  for (int i = 0; i <= parts; ++i) {
    const double theta = 0.5 * std::numbers::pi * i / parts;
    profile.push_back({edge * (1 - std::sin(theta)), radius + edge * (1 - std::cos(theta))});
  }
  const double flat = radius + edge, far = std::max(0.5 * shown.size, 1.5 * flat);
  for (int i = 1; i <= 4; ++i) profile.push_back({0, flat + 0.25 * i * (far - flat)});
  return revolved(vec(face), direction(into), profile, 2 * shown.parts, false);
}

Outline Ellipsoid::outline(const Shown& shown) const {
  Outline out = revolved(Vec3::Zero(), Vec3::UnitY(), half_circle(1, shown.parts), 2 * shown.parts);
  for (Vec3& x : out.points) x = vec(centre) + vec(half_axes).cwiseProduct(x);
  return out;
}

Mat3 Ellipsoid::inverse(const Mat3& A) { return A.inverse(); }

}  // namespace langer
