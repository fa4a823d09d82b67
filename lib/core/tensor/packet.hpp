// Eight doubles that are computed with at once: one lane per element.
// The compiler maps it to the widest registers of the machine; laws and kernels are templates on
// the number type.
#pragma once

#include <cmath>

namespace langer {

struct Packet {
  static constexpr int lanes = 8;
  typedef double Lanes __attribute__((vector_size(64)));
  Lanes v;
  Packet() =
      default;  // P x; has any value, P() and P x{} are zero: kernels do not clear what they fill
  Packet(double x) : v(Lanes{} + x) {}
  explicit Packet(Lanes x) : v(x) {}
  double operator[](int i) const { return v[i]; }
  void set(int i, double x) { v[i] = x; }
  Packet& operator+=(const Packet& b) { return v += b.v, *this; }
  Packet& operator-=(const Packet& b) { return v -= b.v, *this; }
  Packet& operator*=(const Packet& b) { return v *= b.v, *this; }
  friend Packet operator+(const Packet& a, const Packet& b) { return Packet(a.v + b.v); }
  friend Packet operator-(const Packet& a, const Packet& b) { return Packet(a.v - b.v); }
  friend Packet operator*(const Packet& a, const Packet& b) { return Packet(a.v * b.v); }
  friend Packet operator/(const Packet& a, const Packet& b) { return Packet(a.v / b.v); }
  friend Packet operator-(const Packet& a) { return Packet(-a.v); }
  // f of each lane
  friend Packet lanewise(const Packet& a, auto&& f) {
    Packet r;
    for (int i = 0; i < lanes; ++i) r.v[i] = f(a.v[i]);
    return r;
  }
  friend Packet exp(const Packet& a) {
    return lanewise(a, [](double x) { return std::exp(x); });
  }
  friend Packet log1p(const Packet& a) {
    return lanewise(a, [](double x) { return std::log1p(x); });
  }
  friend Packet expm1(const Packet& a) {
    return lanewise(a, [](double x) { return std::expm1(x); });
  }
  friend Packet pow(const Packet& a, double exponent) {
    return lanewise(a, [exponent](double x) { return std::pow(x, exponent); });
  }
  friend Packet sqrt(const Packet& a) {
    return lanewise(a, [](double x) { return std::sqrt(x); });
  }
  friend Packet abs(const Packet& a) {
    return lanewise(a, [](double x) { return std::abs(x); });
  }
  // near 1, where dilatations are: (1 + e)^(1/3) to e^3, and one step of Halley, which cubes what
  // is left of it
  friend Packet cbrt(const Packet& a) {
    const Packet e = a - 1.0;
    const Packet r = 1.0 + e * (1.0 / 3 - e * (1.0 / 9));
    bool near = true;
    for (int i = 0; i < lanes; ++i) near = near && std::abs(e.v[i]) < 1e-2;
    if (near) {
      const Packet cube = r * r * r;
      return r + r * ((a - cube) / (2.0 * cube + a));
    }
    return lanewise(a, [](double x) { return std::cbrt(x); });
  }
};

// x where test >= 0, else 0
inline Packet where_not_negative(const Packet& test, const Packet& x) {
  return Packet(test.v >= 0 ? x.v : Packet::Lanes{});
}
inline double where_not_negative(double test, double x) { return test >= 0 ? x : 0; }

// x where test >= 0, else y
inline Packet where_not_negative(const Packet& test, const Packet& x, const Packet& y) {
  return Packet(test.v >= 0 ? x.v : y.v);
}
inline double where_not_negative(double test, double x, double y) { return test >= 0 ? x : y; }

// |a| < most in every lane; not of NaN, without a trap
inline bool within(double a, double most) { return std::isless(std::abs(a), most); }
inline bool within(const Packet& a, double most) {
  bool all = true;
  for (int i = 0; i < Packet::lanes; ++i) all = all && within(a.v[i], most);
  return all;
}

inline double smallest(const Packet& a) {
  double m = a.v[0];
  for (int i = 1; i < Packet::lanes; ++i) m = a.v[i] < m || !(a.v[i] == a.v[i]) ? a.v[i] : m;
  return m;
}

}  // namespace langer
