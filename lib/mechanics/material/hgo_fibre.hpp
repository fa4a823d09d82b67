// Exponential fibre energy  W = c1/(2 c2) (exp(c2 x^2) - 1),  x = I4_bar - 1.          [A23] eq.
// 14, [HGO00]
//   c1 [MPa] any sign (the paper identifies c1 < 0: W is then unbounded below)
//   c2 [-] >= 0; at c2 = 0 the limit  W = c1 x^2 / 2.
// Where the fibre is slack the caller sets the term to zero (FibreSwitch in fibre.hpp).
#pragma once

#include <cmath>

#include "core/base/fields.hpp"
#include "core/base/search_bounds.hpp"
#include "mechanics/material/energy.hpp"

namespace langer {

struct HgoFibre {
  static constexpr const char* key = "hgo";
  double c1 = 0, c2 = 0;
  static void fields(auto& v) {
    v(&HgoFibre::c1, "c1", unit::MPa, "fibre modulus", required);
    // Skin in vivo, and porcine skin in its stiff directions, has exponents above 10.
    v(&HgoFibre::c2, "c2", unit::none, "exponent", required, at_least(0),
      SearchBounds{.low = 0, .high = 100, .small_values_first = true});
  }
  double modulus() const { return c1; }
  // W = c1/2 x^2 phi(c2 x^2) with phi(y) = (exp(y) - 1)/y, regular at c2 = 0
  template <class T>
  Energy<T> operator()(T I4_bar) const {
    using std::exp;
    const T x = I4_bar - 1.0;
    const T x2 = x * x;
    const T y = c2 * x2;
    const T e = exp(y);
    return {energy(x2, y, e), c1 * x * e, c1 * e * (1.0 + 2 * y)};
  }

 private:
  // For small y the difference e - 1 loses digits, e = exp(y); the series of phi keeps them.
  template <class T>
  T energy(T x2, T y, T e) const {
    if (c2 > 1e-6) return c1 / (2 * c2) * (e - 1.0);
    return (0.5 * c1) * x2 * (1.0 + 0.5 * y * (1.0 + y * (1.0 / 3)));
  }
};

}  // namespace langer
