// Fibre energy of an exponential of a power, the "fiber-exp-pow" of FEBio [MEAW12]:
//   W = ksi/(alpha beta) (exp(alpha y^beta) - 1),  y = |I4_bar - 1|;   at alpha = 0 the limit  W = ksi y^beta / beta
//   ksi [MPa] >= 0; alpha [-] >= 0; beta [-] >= 2, so that W is twice differentiable where the fibre begins to bear
// beta = 2 is HGO's energy with c1 = ksi and c2 = alpha. The absolute value matters where the
// switch lets a fibre push.
#pragma once

#include <cmath>

#include "core/base/fields.hpp"
#include "core/base/search_bounds.hpp"
#include "mechanics/material/energy.hpp"

namespace langer {

struct ExpPowFibre {
  static constexpr const char* key = "exp_pow";
  double ksi = 0, alpha = 0, beta = 2;
  static void fields(auto& v) {
    v(&ExpPowFibre::ksi, "ksi", unit::MPa, "fibre modulus", required, at_least(0));
    v(&ExpPowFibre::alpha, "alpha", unit::none, "coefficient in the exponent; 0: a power law",
      at_least(0), SearchBounds{0, 100});
    v(&ExpPowFibre::beta, "beta", unit::none, "power of (I4_bar - 1); 2: the energy of hgo",
      at_least(2));
  }
  double modulus() const { return ksi; }
  template <class T>
  Energy<T> operator()(T I4_bar) const {
    using std::abs, std::expm1, std::pow;
    const T x = I4_bar - 1.0;
    const T y = abs(x);
    const T power = beta == 2 ? T(1.0) : T(pow(y, beta - 2));  // y^(beta - 2)
    const T y_beta = power * y * y;
    const T grown = expm1(T(alpha * y_beta));
    const T e = 1.0 + grown;
    const T W = alpha > 0 ? T(ksi / (alpha * beta) * grown) : T(ksi / beta * y_beta);
    return {W, ksi * x * power * e, ksi * power * e * ((beta - 1) + alpha * beta * y_beta)};
  }
};

}  // namespace langer
