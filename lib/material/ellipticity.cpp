#include "material/ellipticity.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tensor/kinematics.hpp"
#include "tensor/stress.hpp"

namespace langer {

namespace {

// The acoustic problem of one state: Q(n) = n.c.n + (n.sigma n) I on the plane normal to n.
struct Acoustic {
  Mat6 c;  // spatial, rows and columns 11 22 33 12 23 13
  Mat3 sigma;

  bool finite() const { return c.allFinite() && sigma.allFinite(); }
  ShearStiffness at(const Vec3& n) const {
    // (m n) in strain order: Q = B^T c B with B m = the engineering components of sym(m n)
    Eigen::Matrix<double, 6, 3> B;
    B << n[0], 0, 0, 0, n[1], 0, 0, 0, n[2], n[1], n[0], 0, 0, n[2], n[1], n[2], 0, n[0];
    const Mat3 Q = B.transpose() * c * B + n.dot(sigma * n) * Mat3::Identity();
    const Vec3 s = n.unitOrthogonal(), t = n.cross(s);
    const double a = s.dot(Q * s), b = s.dot(Q * t), d = t.dot(Q * t);
    const double root = std::hypot(0.5 * (a - d), b), value = 0.5 * (a + d) - root;
    // eigenvector of the smaller eigenvalue: angle phi from s
    const double phi = root > 0 ? 0.5 * std::atan2(-2 * b, d - a) : 0;
    return {value, n, std::cos(phi) * s + std::sin(phi) * t};
  }
};

Mat6 push_forward(const Mat3& F, const Mat6& D, double J) {
  // T maps components of a symmetric reference tensor to those of F A F^T; D carries engineering strains on both sides
  Mat6 T;
  for (int p = 0; p < 6; ++p)
    for (int q = 0; q < 6; ++q) {
      const int i = voigt_i[p], j = voigt_j[p], k = voigt_i[q], l = voigt_j[q];
      T(p, q) = k == l ? F(i, k) * F(j, k) : F(i, k) * F(j, l) + F(i, l) * F(j, k);
    }
  return T * D * T.transpose() / J;
}

Acoustic acoustic_at(const Material& material, const Mat3& F, std::span<const Vec3> a) {
  const double J = F.determinant();
  const Response r = isochoric(material, right_cauchy_green(F), a);
  return {push_forward(F, r.D, J), cauchy(F, r.S, J)};
}

bool lower(const ShearStiffness& x, const ShearStiffness& y) { return x.value < y.value; }

// The best of eight normals at distance `reach` and of the bottom of the paraboloid through them.
ShearStiffness best_nearby(const Acoustic& acoustic, const ShearStiffness& place, double reach) {
  const Vec3 s = place.n.unitOrthogonal(), t = place.n.cross(s);
  const auto at = [&](double x, double y) { return acoustic.at((place.n + reach * (x * s + y * t)).normalized()); };
  const ShearStiffness e = at(1, 0), w = at(-1, 0), n = at(0, 1), o = at(0, -1);
  const ShearStiffness ne = at(1, 1), sw = at(-1, -1), se = at(1, -1), nw = at(-1, 1);
  const double gx = (e.value - w.value) / 2, gy = (n.value - o.value) / 2;
  const double hxx = e.value - 2 * place.value + w.value, hyy = n.value - 2 * place.value + o.value;
  const double hxy = (ne.value + sw.value - se.value - nw.value) / 4, det = hxx * hyy - hxy * hxy;
  ShearStiffness best = std::min({e, w, n, o, ne, sw, se, nw}, lower);
  if (hxx > 0 && det > 0) {
    const double x = (-hyy * gx + hxy * gy) / det, y = (hxy * gx - hxx * gy) / det, far = std::hypot(x, y);
    const double shorter = std::min(1., 10 / std::max(far, 1e-300));
    best = std::min(best, at(shorter * x, shorter * y), lower);
  }
  return best;
}

}  // namespace

Vec3 wave_normal(int i, int n) {
  const double z = (i + 0.5) / n, angle = i * std::numbers::pi * (3 - std::sqrt(5.)), s = std::sqrt(1 - z * z);
  return {s * std::cos(angle), s * std::sin(angle), z};
}

double sampled_shear_stiffness(const Material& material, const Mat3& F, std::span<const Vec3> a, int n) {
  const Acoustic acoustic = acoustic_at(material, F, a);
  if (!acoustic.finite()) return std::numeric_limits<double>::quiet_NaN();
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < n; ++i) least = std::min(least, acoustic.at(wave_normal(i, n)).value);
  return least;
}

ShearStiffness smallest_shear_stiffness(const Material& material, const Mat3& F, std::span<const Vec3> a) {
  const Acoustic acoustic = acoustic_at(material, F, a);
  if (!acoustic.finite()) return {std::numeric_limits<double>::quiet_NaN(), Vec3::UnitX(), Vec3::UnitY()};

  // an even grid on the half sphere, then downhill from its best places
  constexpr int grid = 400, best = 6;
  std::vector<ShearStiffness> found;
  for (int i = 0; i < grid; ++i) found.push_back(acoustic.at(wave_normal(i, grid)));
  const auto [least, greatest] = std::minmax_element(found.begin(), found.end(), lower);
  const double enough = 1e-2 * (greatest->value - least->value);  // of decrease per reach^2: rounding must not be followed
  std::partial_sort(found.begin(), found.begin() + best, found.end(), lower);
  for (int k = 0; k < best; ++k) {
    ShearStiffness& place = found[static_cast<std::size_t>(k)];
    for (double reach = 0.1; reach > 1e-6;) {
      const ShearStiffness next = best_nearby(acoustic, place, reach);
      if (next.value < place.value - enough * reach * reach)
        place = next;
      else
        reach /= 2;
    }
  }
  return *std::min_element(found.begin(), found.begin() + best, lower);
}

}  // namespace langer
