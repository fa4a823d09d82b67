// Polynomials of both invariants, without mixed products:
//   Mooney-Rivlin  W = c10 (I1_bar - 3) + c01 (I2_bar - 3)                             [M40], [R48]
//   Signorini      W = c10 (I1_bar - 3) + c01 (I2_bar - 3) + c20 (I1_bar - 3)^2        [S55]
// Coefficients in MPa; the shear modulus at rest is 2 (c10 + c01).
#pragma once

#include "core/base/fields.hpp"
#include "mechanics/material/yeoh.hpp"

namespace langer {

struct MooneyRivlin {
  static constexpr const char* key = "mooney_rivlin";
  static constexpr Invariant of = Invariant::I1_bar_and_I2_bar;
  double c10 = 0, c01 = 0;
  static void fields(auto& v) {
    v(&MooneyRivlin::c10, "c10", unit::MPa, "coefficient of (I1_bar - 3)", required);
    v(&MooneyRivlin::c01, "c01", unit::MPa, "coefficient of (I2_bar - 3)", required);
  }
  template <class T>
  Energy<T> of_I1(T I1_bar) const {
    return cubic<T>(c10, 0, 0, I1_bar - 3.0);
  }
  template <class T>
  Energy<T> of_I2(T I2_bar) const {
    return cubic<T>(c01, 0, 0, I2_bar - 3.0);
  }
};

struct Signorini {
  static constexpr const char* key = "signorini";
  static constexpr Invariant of = Invariant::I1_bar_and_I2_bar;
  double c10 = 0, c01 = 0, c20 = 0;
  static void fields(auto& v) {
    v(&Signorini::c10, "c10", unit::MPa, "coefficient of (I1_bar - 3)", required);
    v(&Signorini::c01, "c01", unit::MPa, "coefficient of (I2_bar - 3)", required);
    v(&Signorini::c20, "c20", unit::MPa, "coefficient of (I1_bar - 3)^2", required);
  }
  template <class T>
  Energy<T> of_I1(T I1_bar) const {
    return cubic<T>(c10, c20, 0, I1_bar - 3.0);
  }
  template <class T>
  Energy<T> of_I2(T I2_bar) const {
    return cubic<T>(c01, 0, 0, I2_bar - 3.0);
  }
};

}  // namespace langer
