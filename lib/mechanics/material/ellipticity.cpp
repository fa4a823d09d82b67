#include "mechanics/material/ellipticity.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/tensor/kinematics.hpp"
#include "core/tensor/packet.hpp"
#include "core/tensor/push_forward.hpp"
#include "core/tensor/stress.hpp"
#include "mechanics/material/terms.hpp"

namespace langer {

namespace {

constexpr double rounding = 1e-12;  // of the terms that make a stiffness: a loss by less is none

// Eight vectors.
struct PacketVec3 {
  Packet x, y, z;
  void set(int lane, const Vec3& v) {
    x.set(lane, v[0]);
    y.set(lane, v[1]);
    z.set(lane, v[2]);
  }
  Vec3 at(int lane) const { return {x[lane], y[lane], z[lane]}; }
  friend PacketVec3 operator+(const PacketVec3& a, const PacketVec3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend PacketVec3 operator*(const Packet& k, const PacketVec3& a) {
    return {k * a.x, k * a.y, k * a.z};
  }
};

Packet dot(const PacketVec3& a, const PacketVec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Packet dot(const Vec3& a, const PacketVec3& b) { return a[0] * b.x + a[1] * b.y + a[2] * b.z; }

PacketVec3 cross(const PacketVec3& a, const PacketVec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

PacketVec3 operator*(const Mat3& A, const PacketVec3& v) {
  return {A(0, 0) * v.x + A(0, 1) * v.y + A(0, 2) * v.z,
          A(1, 0) * v.x + A(1, 1) * v.y + A(1, 2) * v.z,
          A(2, 0) * v.x + A(2, 1) * v.y + A(2, 2) * v.z};
}

Packet square_root(const Packet& a) {
  using Row = Eigen::Array<double, Packet::lanes, 1>;
  Packet result;
  Eigen::Map<Row, Eigen::Aligned64>(reinterpret_cast<double*>(&result.v)) =
      Eigen::Map<const Row, Eigen::Aligned64>(reinterpret_cast<const double*>(&a.v)).sqrt();
  return result;
}

PacketVec3 normalized(const PacketVec3& v) { return (1.0 / square_root(dot(v, v))) * v; }

// A unit vector normal to each unit vector n, across its smaller one of x and z.
PacketVec3 unit_orthogonal(const PacketVec3& n) {
  const Packet smaller = n.z * n.z - n.x * n.x;
  const Packet zero = 0.0;
  return normalized({where_not_negative(smaller, zero, -n.y),
                     where_not_negative(smaller, -n.z, n.x),
                     where_not_negative(smaller, n.y, zero)});
}

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
  // of eight normals at once: the values of at(), and its sizes
  struct Eight {
    Packet value, size;
  };
  Eight at(const PacketVec3& n) const;

  // whether a bound from below shows that no stiffness is negative
  bool certainly_positive() const;

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
  bool moderate() const;
  static constexpr std::size_t most_squares_ = 12;  // of a sum in packets

  Mat3 FT_, inverse_;
  double J_ = 1, two_dW1_ = 0, four_ddW1_ = 0, two_dW2_ = 0, four_ddW2_ = 0;
  std::vector<Family> families_;
  std::vector<Vec3> f_;
  bool of_stretches_ = false, finite_ = true, moderate_ = true;
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
  moderate_ = finite_ && moderate();
}

// Whether squares of all terms are far from overflow, so that packets need no std::hypot.
bool Acoustic::moderate() const {
  constexpr double most = 1e60;
  if (families_.size() + 5 > most_squares_) return false;
  double size = FT_.squaredNorm() + inverse_.squaredNorm();
  size *= 1 + std::abs(two_dW1_) + std::abs(four_ddW1_) + std::abs(two_dW2_) + std::abs(four_ddW2_);
  for (const Family& k : families_)
    size += (1 + k.f.squaredNorm()) * (1 + std::abs(k.two_dW) + std::abs(k.four_ddW));
  return !of_stretches_ && std::isless(size, most);
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

// With h_k = b of I1_bar, kappa b + (1 - 3 kappa) f f^T of a family:
//   A J = sum 2 W_k' n.h_k n + 4 W_k'' (m.h_k n)^2 >= n.(sum (2 W_k' + min(0, 4 W_k'' tr h_k)) h_k) n
// because (m.h n)^2 <= (m.h m) (n.h n). Terms of I2_bar add what is not negative where their
// derivatives are not.
bool Acoustic::certainly_positive() const {
  if (!moderate_ || two_dW2_ < 0 || four_ddW2_ < 0) return false;
  const Mat3 b = FT_.transpose() * FT_;
  Mat3 bound = Mat3::Zero();
  double size = 0;
  const auto add = [&](double two_dW, double four_ddW, const Mat3& h) {
    bound += (two_dW + std::min(0., four_ddW * h.trace())) * h;
    size += (std::abs(two_dW) + std::abs(four_ddW) * h.trace()) * h.trace();
  };
  add(two_dW1_, four_ddW1_, b);
  for (const Family& k : families_)
    add(k.two_dW, k.four_ddW, k.kappa * b + (1 - 3 * k.kappa) * k.f * k.f.transpose());
  bound -= 1e-9 * size * Mat3::Identity();  // far more than rounding
  const double minor = bound(0, 0) * bound(1, 1) - bound(0, 1) * bound(0, 1);
  return bound(0, 0) > 0 && minor > 0 && bound.determinant() > 0;
}

// The same sums as squares() and at() above, without the polarisation.
Acoustic::Eight Acoustic::at(const PacketVec3& n) const {
  Eight result{};
  if (!moderate_) {
    for (int lane = 0; lane < Packet::lanes; ++lane) {
      const ShearStiffness one = at(n.at(lane));
      result.value.set(lane, one.value);
      result.size.set(lane, one.size);
    }
    return result;
  }
  struct Squares {
    double weight;
    Packet x, y;
  };
  std::array<Squares, most_squares_> squares;
  std::size_t many = 0;
  Packet same = 0.0;
  Packet size = 0.0;
  const auto add = [&](double two_dW, double four_ddW, double I, const Packet& d) {
    same += two_dW * d;
    size += (std::abs(two_dW) + std::abs(four_ddW) * I) * d;
  };
  const PacketVec3 s = unit_orthogonal(n);
  const PacketVec3 t = cross(n, s);
  const PacketVec3 p = FT_ * n;
  const Packet pp = dot(p, p);
  const Packet x = dot(p, FT_ * s);
  const Packet y = dot(p, FT_ * t);
  const double I1 = FT_.squaredNorm();
  add(two_dW1_, four_ddW1_, I1, pp);
  squares[many++] = {four_ddW1_, x, y};
  for (const Family& k : families_) {
    const double part = 1 - 3 * k.kappa;
    const Packet fn = dot(k.f, n);
    add(k.two_dW, k.four_ddW, k.kappa * I1 + part * k.f.squaredNorm(),
        k.kappa * pp + part * fn * fn);
    squares[many++] = {k.four_ddW, k.kappa * x + part * fn * dot(k.f, s),
                       k.kappa * y + part * fn * dot(k.f, t)};
  }
  if (two_dW2_ != 0 || four_ddW2_ != 0) {
    const PacketVec3 o = inverse_ * n;
    const PacketVec3 r_s = inverse_ * s;
    const PacketVec3 r_t = inverse_ * t;
    squares[many++] = {four_ddW2_, dot(o, r_s), dot(o, r_t)};
    squares[many++] = {two_dW2_, r_s.x, r_t.x};
    squares[many++] = {two_dW2_, r_s.y, r_t.y};
    squares[many++] = {two_dW2_, r_s.z, r_t.z};
  }
  Packet a = 0.0;
  Packet b = 0.0;
  Packet d = 0.0;
  Packet det = 0.0;
  for (std::size_t k = 0; k < many; ++k) {
    const auto& [w, x_k, y_k] = squares[k];
    a += w * x_k * x_k;
    b += w * x_k * y_k;
    d += w * y_k * y_k;
    for (std::size_t l = 0; l < k; ++l) {
      const Packet cross = x_k * squares[l].y - y_k * squares[l].x;
      det += w * squares[l].weight * cross * cross;
    }
  }
  const Packet apart = a - d;
  const Packet distance = square_root(apart * apart + 4.0 * b * b);
  const Packet trace = a + d;
  // the quotient where the trace is above 0, and 1 below the line where it is not used
  const Packet positive = trace - std::numeric_limits<double>::min();
  const Packet below = where_not_negative(positive, trace + distance, Packet(1.0));
  const Packet value = where_not_negative(positive, 2.0 * det / below, 0.5 * (trace - distance));
  result.value = (same + value) / J_;
  result.size = (size + 0.5 * (abs(trace) + distance)) / J_;
  return result;
}

bool lower(const ShearStiffness& x, const ShearStiffness& y) { return x.value < y.value; }

// A place of the search for the smallest stiffness.
struct WavePlace {
  Vec3 n;
  double value = 0;
  double reach = 0.1;  // distance of the neighbours that are looked at
  int moved = 0;
  bool arrived() const {
    constexpr int moves = 100;
    return !(reach > 1e-6) || moved >= moves;
  }
};

// The neighbours of a place: eight normals at the distance of its reach, and the bottom of the
// paraboloid through them, where there is one.
struct WaveNeighbours {
  static constexpr int x[] = {1, -1, 0, 0, 1, -1, 1, -1};
  static constexpr int y[] = {0, 0, 1, -1, 1, -1, -1, 1};
  PacketVec3 n;
  Packet value;
  Vec3 s, t, bottom;
  bool has_bottom = false;

  WaveNeighbours(const Acoustic& acoustic, const WavePlace& place) {
    s = place.n.unitOrthogonal();
    t = place.n.cross(s);
    static const Packet along_s = of(x);
    static const Packet along_t = of(y);
    const Packet a = place.reach * along_s;
    const Packet b = place.reach * along_t;
    n = normalized({place.n[0] + a * s[0] + b * t[0], place.n[1] + a * s[1] + b * t[1],
                    place.n[2] + a * s[2] + b * t[2]});
    value = acoustic.at(n).value;
    const double gx = (value[0] - value[1]) / 2;
    const double gy = (value[2] - value[3]) / 2;
    const double hxx = value[0] - 2 * place.value + value[1];
    const double hyy = value[2] - 2 * place.value + value[3];
    const double hxy = (value[4] + value[5] - value[6] - value[7]) / 4;
    const double det = hxx * hyy - hxy * hxy;
    has_bottom = hxx > 0 && det > 0;
    bottom = place.n;
    if (!has_bottom) return;
    const double to_x = (-hyy * gx + hxy * gy) / det;
    const double to_y = (hxy * gx - hxx * gy) / det;
    const double far = std::hypot(to_x, to_y);
    const double step = std::min(1., 10 / std::max(far, 1e-300)) * place.reach;
    bottom = (place.n + step * (to_x * s + to_y * t)).normalized();
  }

 private:
  static Packet of(const int* values) {
    Packet p;
    for (int lane = 0; lane < Packet::lanes; ++lane) p.set(lane, values[lane]);
    return p;
  }
};

// Moves up to eight places downhill, all at once. Each ends short of its minimum by less than a
// millionth of its size or of the largest stiffness. Returns the lowest.
WavePlace downhill(const Acoustic& acoustic, std::vector<WavePlace> places, double largest) {
  std::array<WavePlace, Packet::lanes> best;
  std::array<bool, Packet::lanes> has_bottom;
  const auto going = [](const WavePlace& place) {
    return !place.arrived();
  };
  while (std::any_of(places.begin(), places.end(), going)) {
    PacketVec3 bottoms;
    for (int lane = 0; lane < Packet::lanes; ++lane) bottoms.set(lane, places[0].n);
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (places[k].arrived()) continue;
      const WaveNeighbours around(acoustic, places[k]);
      int lowest = 0;
      for (int lane = 1; lane < Packet::lanes; ++lane)
        if (around.value[lane] < around.value[lowest]) lowest = lane;
      best[k] = places[k];
      best[k].n = around.n.at(lowest);
      best[k].value = around.value[lowest];
      has_bottom[k] = around.has_bottom;
      bottoms.set(static_cast<int>(k), around.bottom);
    }
    const Packet value = acoustic.at(bottoms).value;
    for (std::size_t k = 0; k < places.size(); ++k) {
      WavePlace& place = places[k];
      if (place.arrived()) continue;
      const int lane = static_cast<int>(k);
      if (has_bottom[k] && value[lane] < best[k].value) {
        best[k].n = bottoms.at(lane);
        best[k].value = value[lane];
      }
      // rounding must not be followed
      const double enough =
          1e-3 * place.reach * place.reach * std::max(std::abs(place.value), 1e-6 * largest);
      if (best[k].value < place.value - enough) {
        place = best[k];
        ++place.moved;
      } else {
        place.reach /= 2;
      }
    }
  }
  return *std::min_element(
      places.begin(), places.end(),
      [](const WavePlace& a, const WavePlace& b) { return a.value < b.value; });
}

// Waves normal to a fibre do not feel it. Where it is far stiffer than the rest they are a groove
// that no step on the sphere finds.
ShearStiffness least_around(const Acoustic& acoustic, const Vec3& f) {
  constexpr int places = 48;
  const Vec3 along = f.normalized();
  const Vec3 u = along.unitOrthogonal();
  const Vec3 v = along.cross(u);
  // the cosines and sines of eight angles in equal steps about a middle
  const auto eight = [&](double middle, double step, double first) {
    PacketVec3 n;
    for (int lane = 0; lane < Packet::lanes; ++lane) {
      const double angle = middle + (first + lane) * step;
      n.set(lane, std::cos(angle) * u + std::sin(angle) * v);
    }
    return n;
  };
  double step = std::numbers::pi / places;
  double best = 0;
  double least = std::numeric_limits<double>::infinity();
  const auto take = [&](double middle, double first) {
    const Packet value = acoustic.at(eight(middle, step, first)).value;
    for (int lane = 0; lane < Packet::lanes; ++lane)
      if (value[lane] < least) {
        least = value[lane];
        best = middle + (first + lane) * step;
      }
  };
  for (int i = 0; i < places; i += Packet::lanes) take(0, i);
  // eight angles halfway between and beside the last ones leave a quarter of the step
  for (; step > 1e-7;) {
    step /= 4;
    take(best, -3.5);
  }
  return acoustic.at(std::cos(best) * u + std::sin(best) * v);
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

namespace {

// The stiffness at an even grid of normals on the half sphere.
struct WaveGrid {
  static constexpr int size = 400, best = 6;
  std::array<std::pair<double, int>, size> found;  // the first `best` are the lowest
  double largest = 0;                              // of the sizes

  explicit WaveGrid(const Acoustic& acoustic) {
    Packet largest_of = 0.0;
    for (int i = 0; i < size; i += Packet::lanes) {
      const Acoustic::Eight at =
          acoustic.at(normals()[static_cast<std::size_t>(i / Packet::lanes)]);
      largest_of = Packet(at.size.v > largest_of.v ? at.size.v : largest_of.v);
      for (int lane = 0; lane < Packet::lanes; ++lane)
        found[static_cast<std::size_t>(i + lane)] = {at.value[lane], i + lane};
    }
    for (int lane = 0; lane < Packet::lanes; ++lane) largest = std::max(largest, largest_of[lane]);
    std::partial_sort(found.begin(), found.begin() + best, found.end());
  }

  WavePlace place(int k) const {
    const auto [value, i] = found[static_cast<std::size_t>(k)];
    const PacketVec3& eight = normals()[static_cast<std::size_t>(i / Packet::lanes)];
    return {eight.at(i % Packet::lanes), value};
  }

 private:
  using Normals = std::array<PacketVec3, size / Packet::lanes>;
  static const Normals& normals() {
    static const Normals all = [] {
      Normals n;
      for (int i = 0; i < size; ++i)
        n[static_cast<std::size_t>(i / Packet::lanes)].set(i % Packet::lanes, wave_normal(i, size));
      return n;
    }();
    return all;
  }
};

// downhill from the best places of the grid and of the waves normal to fibres
ShearStiffness least_from(const Acoustic& acoustic, const WaveGrid& grid) {
  std::vector<WavePlace> places;
  for (int k = 0; k < WaveGrid::best; ++k) places.push_back(grid.place(k));
  const ShearStiffness of_fibres = least_of_fibres(acoustic);
  if (std::isfinite(of_fibres.value)) places.push_back({of_fibres.n, of_fibres.value});
  ShearStiffness least = acoustic.at(downhill(acoustic, places, grid.largest).n);
  if (of_fibres.value < least.value) least = of_fibres;
  least.value = without_rounding(least.value, least.size);
  return least;
}

}  // namespace

ShearStiffness smallest_shear_stiffness(const Material& material, const Mat3& F,
                                        std::span<const Vec3> a) {
  const Acoustic acoustic(material, F, a);
  if (!acoustic.finite())
    return {std::numeric_limits<double>::quiet_NaN(), Vec3::UnitX(), Vec3::UnitY(), 0};
  return least_from(acoustic, WaveGrid(acoustic));
}

double sign_of_shear_stiffness(const Material& material, const Mat3& F, std::span<const Vec3> a) {
  const Acoustic acoustic(material, F, a);
  if (!acoustic.finite()) return std::numeric_limits<double>::quiet_NaN();
  if (acoustic.certainly_positive()) return 1;
  const WaveGrid grid(acoustic);
  if (grid.place(0).value < -1e-6 * grid.largest) return -1;
  const double least = least_from(acoustic, grid).value;
  if (least > 0) return 1;
  if (least < 0) return -1;
  return 0;
}

}  // namespace langer
