// Yeoh's polynomial  W = a1 x + a2 x^2 + a3 x^3,  x = I1_bar - 3.                      [A23] eq.
// 13, [Y93] YeohI2 is the same polynomial of I2_bar - 3: the terms C4..C6 of the law (44).
// Coefficients in MPa; a negative a1 means a negative shear modulus at rest (allowed, reported by
// fit).
#pragma once

#include "core/base/fields.hpp"
#include "mechanics/material/energy.hpp"

namespace langer {

template <class T>
Energy<T> cubic(double a1, double a2, double a3, T x) {
  return {x * (a1 + x * (a2 + x * a3)), a1 + x * (2 * a2 + x * (3 * a3)), 2 * a2 + x * (6 * a3)};
}

struct Yeoh {
  static constexpr const char* key = "yeoh";
  static constexpr Invariant of = Invariant::I1_bar;
  double a1 = 0, a2 = 0, a3 = 0;
  static void fields(auto& v) {
    v(&Yeoh::a1, "a1", unit::MPa, "coefficient of (I1_bar - 3): half the initial shear modulus",
      required);
    v(&Yeoh::a2, "a2", unit::MPa, "coefficient of (I1_bar - 3)^2");
    v(&Yeoh::a3, "a3", unit::MPa, "coefficient of (I1_bar - 3)^3");
  }
  template <class T>
  Energy<T> operator()(T I1_bar) const {
    return cubic<T>(a1, a2, a3, I1_bar - 3.0);
  }
};

struct YeohI2 {
  static constexpr const char* key = "yeoh_I2";
  static constexpr Invariant of = Invariant::I2_bar;
  double b1 = 0, b2 = 0, b3 = 0;
  static void fields(auto& v) {
    v(&YeohI2::b1, "b1", unit::MPa, "coefficient of (I2_bar - 3)", required);
    v(&YeohI2::b2, "b2", unit::MPa, "coefficient of (I2_bar - 3)^2");
    v(&YeohI2::b3, "b3", unit::MPa, "coefficient of (I2_bar - 3)^3");
  }
  template <class T>
  Energy<T> operator()(T I2_bar) const {
    return cubic<T>(b1, b2, b3, I2_bar - 3.0);
  }
};

}  // namespace langer
