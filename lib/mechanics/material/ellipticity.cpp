#include "mechanics/material/ellipticity.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/tensor/kinematics.hpp"
#include "core/tensor/stress.hpp"
#include "mechanics/material/terms.hpp"

namespace langer {

namespace {

Mat6 push_forward(const Mat3& F, const Mat6& D, double J) {
  // T maps components of a symmetric reference tensor to those of F A F^T; D carries engineering
  // strains on both sides
  Mat6 T;
  for (int p = 0; p < 6; ++p)
    for (int q = 0; q < 6; ++q) {
      const int i = voigt_i[p];
      const int j = voigt_j[p];
      const int k = voigt_i[q];
      const int l = voigt_j[q];
      if (k == l) {
        T(p, q) = F(i, k) * F(j, k);
      } else {
        T(p, q) = F(i, k) * F(j, l) + F(i, l) * F(j, k);
      }
    }
  return T * D * T.transpose() / J;
}

constexpr double rounding = 1e-12;  // of the terms that make a stiffness: a loss by less is none

// The acoustic problem of one state as the second derivative of the energy along 1 + eps m n^T,
// which leaves J alone:
//   A(n, m) J = sum_k 2 W_k' d_k + 4 W_k'' (x_k)^2,  with p = F^T n, q = F^T m, r = F^-1 m, o = F^-1 n (F isochoric), f = F a
//   I1_bar  d = p.p, x = p.q        I2_bar  d = r.r, x = o.r
//   fibre   d = kappa p.p + (1 - 3 kappa) (f.n)^2, x = kappa p.q + (1 - 3 kappa) (f.n)(f.m)
// A sum of what is not negative where no W' and W'' is: stiff terms do not round soft ones away.
// Laws of the stretches (Ogden) have n.c.n + (n.sigma n) I in place of it.
class Acoustic {
 public:
  Acoustic(const Material& material, const Mat3& F, std::span<const Vec3> a);

  bool finite() const { return finite_; }
  const std::vector<Vec3>& fibres() const { return f_; }
  ShearStiffness at(const Vec3& n) const;

 private:
  // weight (m.v)^2, v in the plane normal to n
  struct Square {
    double weight, x, y;
  };
  struct Family {
    double kappa, two_dW, four_ddW;
    Vec3 f;
  };
  struct Part {
    double value = 0, size = 0;
    // d > 0; the derivative dW is known to the rounding of its invariant I, which ddW makes a
    // stiffness
    void add(double two_dW, double four_ddW, double I, double d) {
      value += two_dW * d;
      size += (std::abs(two_dW) + std::abs(four_ddW) * I) * d;
    }
  };
  Part squares(const Vec3& n, const Vec3& s, const Vec3& t) const;

  Mat3 FT_, inverse_;
  double J_ = 1, two_dW1_ = 0, four_ddW1_ = 0, two_dW2_ = 0, four_ddW2_ = 0;
  std::vector<Family> families_;
  std::vector<Vec3> f_;
  bool of_stretches_ = false, finite_ = true;
  Mat6 c_ =
      Mat6::Zero();  // spatial, rows and columns 11 22 33 12 23 13; of laws of the stretches alone
  Mat3 sigma_ = Mat3::Zero();
  mutable std::vector<Square> squares_;
};

// invariants of an isochoric F as for_each_term() asks for them; f = F a of a family
struct DeformedState {
  const Mat3& FT;  // F^T, isochoric
  std::span<const Vec3> a;
  double I1, I2, factor;
  struct Family {
    double kappa;
    Vec3 f;
    double I;
  };
  double I1_bar() const { return I1; }
  double I2_bar() const { return I2; }
  double m() const { return factor; }
  Family family(const Fibre& fibre, std::size_t k) const {
    const Vec3 f = FT.transpose() * a[k];
    return {fibre.kappa, f, fibre.kappa * I1 + (1 - 3 * fibre.kappa) * f.squaredNorm()};
  }
};

Acoustic::Acoustic(const Material& material, const Mat3& F, std::span<const Vec3> a) {
  J_ = F.determinant();
  const double root = std::cbrt(J_);
  FT_ = F.transpose() / root;
  inverse_ = F.inverse() * root;
  const DeformedState state{FT_, a, FT_.squaredNorm(), inverse_.squaredNorm(), 1 / (root * root)};
  Material stretches;
  for_each_term<double>(
      material, state,
      Overloaded{[&](OfI1, const Energy<double>& e) {
                   two_dW1_ += 2 * e.dW;
                   four_ddW1_ += 4 * e.ddW;
                 },
                 [&](OfI2, const Energy<double>& e) {
                   two_dW2_ += 2 * e.dW;
                   four_ddW2_ += 4 * e.ddW;
                 },
                 [&](const Ogden& law) {
                   of_stretches_ = true;
                   stretches.matrix.push_back(law);
                 },
                 [&](const DeformedState::Family& family, const Energy<double>& e) {
                   families_.push_back({family.kappa, 2 * e.dW, 4 * e.ddW, family.f});
                   f_.push_back(family.f);
                   finite_ = finite_ && std::isfinite(e.dW) && std::isfinite(e.ddW);
                 }});
  if (of_stretches_) {
    const Response r = isochoric(stretches, right_cauchy_green(F), {});
    c_ = push_forward(F, r.D, J_);
    sigma_ = cauchy(F, r.S, J_);
  }
  finite_ = finite_ && std::isfinite(two_dW1_ + four_ddW1_ + two_dW2_ + four_ddW2_) &&
            c_.allFinite() && sigma_.allFinite() && FT_.allFinite() && inverse_.allFinite();
}

// gathers what depends on m; what does not is returned
Acoustic::Part Acoustic::squares(const Vec3& n, const Vec3& s, const Vec3& t) const {
  squares_.clear();
  const Vec3 p = FT_ * n;
  const Vec3 q_s = FT_ * s;
  const Vec3 q_t = FT_ * t;
  const double pp = p.squaredNorm();
  const double x = p.dot(q_s);
  const double y = p.dot(q_t);
  Part same;
  same.add(two_dW1_, four_ddW1_, FT_.squaredNorm(), pp);
  squares_.push_back({four_ddW1_, x, y});
  for (const Family& k : families_) {
    const double part = 1 - 3 * k.kappa;
    const double fn = k.f.dot(n);
    same.add(k.two_dW, k.four_ddW, k.kappa * FT_.squaredNorm() + part * k.f.squaredNorm(),
             k.kappa * pp + part * fn * fn);
    squares_.push_back(
        {k.four_ddW, k.kappa * x + part * fn * k.f.dot(s), k.kappa * y + part * fn * k.f.dot(t)});
  }
  if (two_dW2_ != 0 || four_ddW2_ != 0) {
    const Vec3 o = inverse_ * n;
    const Vec3 r_s = inverse_ * s;
    const Vec3 r_t = inverse_ * t;
    squares_.push_back({four_ddW2_, o.dot(r_s), o.dot(r_t)});
    for (int i = 0; i < 3; ++i) squares_.push_back({two_dW2_, r_s[i], r_t[i]});
  }
  return same;
}

// the smaller eigenvalue of [a b; b d] = sum w (x, y)(x, y)^T, whose determinant is sum w_k w_l
// (x_k y_l - x_l y_k)^2
ShearStiffness Acoustic::at(const Vec3& n) const {
  const Vec3 s = n.unitOrthogonal();
  const Vec3 t = n.cross(s);
  const Part same = squares(n, s, t);
  double a = 0, b = 0, d = 0, det = 0;
  for (std::size_t k = 0; k < squares_.size(); ++k) {
    const auto& [w, x, y] = squares_[k];
    a += w * x * x;
    b += w * x * y;
    d += w * y * y;
    for (std::size_t l = 0; l < k; ++l) {
      const double cross = x * squares_[l].y - y * squares_[l].x;
      det += w * squares_[l].weight * cross * cross;
    }
  }
  if (of_stretches_) {
    // (m n) in strain order: Q = B^T c B with B m = the engineering components of sym(m n)
    Eigen::Matrix<double, 6, 3> B;
    B << n[0], 0, 0, 0, n[1], 0, 0, 0, n[2], n[1], n[0], 0, 0, n[2], n[1], n[2], 0, n[0];
    const Mat3 Q = J_ * (B.transpose() * c_ * B + n.dot(sigma_ * n) * Mat3::Identity());
    a += s.dot(Q * s);
    b += s.dot(Q * t);
    d += t.dot(Q * t);
  }
  const double root = std::hypot(a - d, 2 * b);
  const double trace = a + d;
  double value = 0;
  if (!of_stretches_ && trace > 0) {
    value = 2 * det / (trace + root);
  } else {
    value = 0.5 * (trace - root);
  }
  // eigenvector of the smaller eigenvalue: angle phi from s
  double phi = 0;
  if (root > 0) phi = 0.5 * std::atan2(-2 * b, d - a);
  const double size =
      same.size + 0.5 * (std::abs(trace) + root) + (of_stretches_ ? J_ * c_.norm() : 0);
  return {(same.value + value) / J_, n, std::cos(phi) * s + std::sin(phi) * t, size / J_};
}

bool lower(const ShearStiffness& x, const ShearStiffness& y) { return x.value < y.value; }

// The best of eight normals at distance `reach` and of the bottom of the paraboloid through them.
ShearStiffness best_nearby(const Acoustic& acoustic, const ShearStiffness& place, double reach) {
  const Vec3 s = place.n.unitOrthogonal();
  const Vec3 t = place.n.cross(s);
  const auto at = [&](double x, double y) {
    return acoustic.at((place.n + reach * (x * s + y * t)).normalized());
  };
  const ShearStiffness e = at(1, 0);
  const ShearStiffness w = at(-1, 0);
  const ShearStiffness n = at(0, 1);
  const ShearStiffness o = at(0, -1);
  const ShearStiffness ne = at(1, 1);
  const ShearStiffness sw = at(-1, -1);
  const ShearStiffness se = at(1, -1);
  const ShearStiffness nw = at(-1, 1);
  const double gx = (e.value - w.value) / 2;
  const double gy = (n.value - o.value) / 2;
  const double hxx = e.value - 2 * place.value + w.value;
  const double hyy = n.value - 2 * place.value + o.value;
  const double hxy = (ne.value + sw.value - se.value - nw.value) / 4;
  const double det = hxx * hyy - hxy * hxy;
  ShearStiffness best = std::min({e, w, n, o, ne, sw, se, nw}, lower);
  if (hxx > 0 && det > 0) {
    const double x = (-hyy * gx + hxy * gy) / det;
    const double y = (hxy * gx - hxx * gy) / det;
    const double far = std::hypot(x, y);
    const double shorter = std::min(1., 10 / std::max(far, 1e-300));
    best = std::min(best, at(shorter * x, shorter * y), lower);
  }
  return best;
}

// downhill from a place; short of it by less than a millionth of its size or of the largest
// stiffness
ShearStiffness downhill(const Acoustic& acoustic, ShearStiffness place, double largest) {
  constexpr int moves = 100;
  int moved = 0;
  for (double reach = 0.1; reach > 1e-6 && moved < moves;) {
    const ShearStiffness next = best_nearby(acoustic, place, reach);
    const double enough =
        1e-3 * reach * reach *
        std::max(std::abs(place.value), 1e-6 * largest);  // rounding must not be followed
    if (next.value < place.value - enough) {
      place = next;
      ++moved;
    } else
      reach /= 2;
  }
  return place;
}

// Waves normal to a fibre do not feel it. Where it is far stiffer than the rest they are a groove
// that no step on the sphere finds.
ShearStiffness least_around(const Acoustic& acoustic, const Vec3& f) {
  constexpr int places = 48;
  const Vec3 along = f.normalized();
  const Vec3 u = along.unitOrthogonal();
  const Vec3 v = along.cross(u);
  const auto at = [&](double angle) {
    return acoustic.at(std::cos(angle) * u + std::sin(angle) * v);
  };
  double step = std::numbers::pi / places;
  double best = 0;
  ShearStiffness least = at(0);
  const auto take = [&](double angle) {
    const ShearStiffness s = at(angle);
    if (s.value < least.value) {
      least = s;
      best = angle;
    }
  };
  for (int i = 1; i < places; ++i) take(i * step);
  for (; step > 1e-7; step /= 2) {
    take(best - step);
    take(best + step);
  }
  return least;
}

ShearStiffness least_of_fibres(const Acoustic& acoustic) {
  const std::vector<Vec3>& f = acoustic.fibres();
  ShearStiffness least{std::numeric_limits<double>::infinity(), Vec3::UnitX(), Vec3::UnitY(), 0};
  for (std::size_t k = 0; k < f.size(); ++k) {
    least = std::min(least, least_around(acoustic, f[k]), lower);
    for (std::size_t l = 0; l < k; ++l)
      if (const Vec3 n = f[k].cross(f[l]); n.norm() > 1e-6 * f[k].norm() * f[l].norm())
        least = std::min(least, acoustic.at(n.normalized()), lower);
  }
  return least;
}

}  // namespace

Vec3 wave_normal(int i, int n) {
  const double z = (i + 0.5) / n;
  const double angle = i * std::numbers::pi * (3 - std::sqrt(5.));
  const double s = std::sqrt(1 - z * z);
  return {s * std::cos(angle), s * std::sin(angle), z};
}

// never of NaN, without a trap
double without_rounding(double value, double size) {
  if (std::isless(value, 0) && std::isgreater(value, -rounding * size)) return 0;
  return value;
}

double sampled_shear_stiffness(const Material& material, const Mat3& F, std::span<const Vec3> a,
                               int n) {
  const Acoustic acoustic(material, F, a);
  if (!acoustic.finite()) return std::numeric_limits<double>::quiet_NaN();
  ShearStiffness least = acoustic.at(wave_normal(0, n));
  for (int i = 1; i < n; ++i) least = std::min(least, acoustic.at(wave_normal(i, n)), lower);
  return without_rounding(least.value, least.size);
}

ShearStiffness smallest_shear_stiffness(const Material& material, const Mat3& F,
                                        std::span<const Vec3> a) {
  const Acoustic acoustic(material, F, a);
  if (!acoustic.finite())
    return {std::numeric_limits<double>::quiet_NaN(), Vec3::UnitX(), Vec3::UnitY(), 0};

  // an even grid on the half sphere, then downhill from its best places
  constexpr int grid = 400, best = 6;
  std::vector<ShearStiffness> found;
  double largest = 0;
  for (int i = 0; i < grid; ++i) {
    found.push_back(acoustic.at(wave_normal(i, grid)));
    largest = std::max(largest, found.back().size);
  }
  std::partial_sort(found.begin(), found.begin() + best, found.end(), lower);
  ShearStiffness least = least_of_fibres(acoustic);
  if (std::isfinite(least.value)) least = downhill(acoustic, least, largest);
  for (int k = 0; k < best; ++k)
    least = std::min(least, downhill(acoustic, found[static_cast<std::size_t>(k)], largest), lower);
  least.value = without_rounding(least.value, least.size);
  return least;
}

}  // namespace langer
