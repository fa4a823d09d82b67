// Automatic differentiation: a number together with its derivatives by N variables.
//   (v, d):   (a + b) = (a.v + b.v, a.d + b.d),   (a b) = (a.v b.v, a.v b.d + b.v a.d), ...
// A function that is written for any number type is differentiated exactly, to rounding, when it is
// called with Jets. A variable is a Jet with one derivative 1.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace langer {

template <int N>
struct Jet {
  using Derivatives = Eigen::Array<double, N, 1>;

  double v = 0;
  Derivatives d = Derivatives::Zero();

  Jet() = default;
  Jet(double value) : v(value) {}
  Jet(double value, const Derivatives& derivatives) : v(value), d(derivatives) {}
  // the variable of this index
  Jet(double value, int index) : v(value) { d[index] = 1; }

  Jet& operator+=(const Jet& b) {
    v += b.v;
    d += b.d;
    return *this;
  }
  Jet operator-() const { return {-v, Derivatives(-d)}; }
  friend Jet operator+(const Jet& a, const Jet& b) { return {a.v + b.v, Derivatives(a.d + b.d)}; }
  friend Jet operator-(const Jet& a, const Jet& b) { return {a.v - b.v, Derivatives(a.d - b.d)}; }
  friend Jet operator*(const Jet& a, const Jet& b) {
    return {a.v * b.v, Derivatives(a.v * b.d + b.v * a.d)};
  }
  friend Jet operator*(double a, const Jet& b) { return {a * b.v, Derivatives(a * b.d)}; }
  friend Jet operator*(const Jet& a, double b) { return b * a; }
  friend Jet operator/(const Jet& a, const Jet& b) {
    const double quotient = a.v / b.v;
    return {quotient, Derivatives((a.d - quotient * b.d) / b.v)};
  }
};

inline double value(double x) { return x; }
inline double root(double x) { return std::sqrt(x); }
template <int N>
double value(const Jet<N>& x) {
  return x.v;
}
template <int N>
Jet<N> root(const Jet<N>& x) {
  const double s = std::sqrt(x.v);
  return {s, typename Jet<N>::Derivatives(x.d / (2 * s))};
}

}  // namespace langer
