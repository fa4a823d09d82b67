// Neo-Hooke  W = a1 (I1_bar - 3), the matrix of the HGO law.                           [A23]
// section 2.2, [M40]
#pragma once

#include "core/base/fields.hpp"
#include "mechanics/material/energy.hpp"

namespace langer {

struct NeoHooke {
  static constexpr const char* key = "neo_hooke";
  static constexpr Invariant of = Invariant::I1_bar;
  double a1 = 0;
  static void fields(auto& v) {
    v(&NeoHooke::a1, "a1", unit::MPa, "half the shear modulus", required);
  }
  template <class T>
  Energy<T> operator()(T I1_bar) const {
    return {a1 * (I1_bar - 3.0), T{} + a1, T{}};
  }
};

}  // namespace langer
