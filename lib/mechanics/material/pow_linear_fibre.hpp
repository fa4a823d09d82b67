// Fibre energy with a toe and a linear region, the "fiber-pow-linear" of FEBio [MEAW12]: crimped
// collagen straightens as a power of the strain up to the stretch lam0, and is straight beyond.
// With I0 = lam0^2, y = |I4_bar - 1|, I = 1 + y:
//   I < I0   W = xi y^beta / beta                                              xi = E/(4 (beta - 1)) I0^(-3/2) (I0 - 1)^(2 - beta)
//   I >= I0  W = b (I - I0) - E (sqrt(I) - lam0) + xi (I0 - 1)^beta / beta     b = xi (I0 - 1)^(beta - 1) + E/(2 lam0)
// W is twice differentiable at I0, and beyond it the nominal stress 2 b lambda - E is linear in the
// stretch.
//   E [MPa] >= 0; lam0 [-] > 1; beta [-] >= 2
#pragma once

#include <cmath>

#include "core/base/fields.hpp"
#include "core/base/search_bounds.hpp"
#include "core/tensor/packet.hpp"
#include "mechanics/material/energy.hpp"

namespace langer {

struct PowLinearFibre {
  static constexpr const char* key = "pow_linear";
  double E = 0, lam0 = 1.1, beta = 2;
  static void fields(auto& v) {
    v(&PowLinearFibre::E, "E", unit::MPa,
      "modulus of the straight fibre: nominal stress over stretch has the slope E (1/lam0 + (lam0^2 - 1)/(2 (beta - 1) lam0^3))",
      required, at_least(0), SearchBounds{0, 1e4});  // tendon has some 1000 MPa
    v(&PowLinearFibre::lam0, "lam0", unit::none,
      "stretch at which the toe ends and the fibre is straight", required,
      Range{1, 10, false, true}, SearchBounds{1.001, 2});
    v(&PowLinearFibre::beta, "beta", unit::none, "power of (I4_bar - 1) in the energy of the toe",
      between(2, 20));
  }
  double modulus() const { return E; }
  template <class T>
  Energy<T> operator()(T I4_bar) const {
    using std::abs, std::pow, std::sqrt;
    const double toe = lam0 * lam0 - 1;
    const double xi = E / (4 * (beta - 1)) / (lam0 * lam0 * lam0) * std::pow(toe, 2 - beta);
    const double slope = xi * std::pow(toe, beta - 1);
    const double b = slope + E / (2 * lam0);
    const double W0 = slope * toe / beta;
    const T x = I4_bar - 1.0;
    const T size = abs(x);
    const T I = 1.0 + size;
    const T root = sqrt(I);
    const T beyond = size - toe;
    const T y = where_not_negative(beyond, T(toe), size);  // no overflow beyond the toe
    const T power = beta == 2 ? T(xi) : T(xi * pow(y, beta - 2));
    const T W =
        where_not_negative(beyond, T(b * beyond - E * (root - lam0) + W0), T(power * y * y / beta));
    const T dW = where_not_negative(beyond, T(b - (0.5 * E) / root), T(power * y));
    const T ddW = where_not_negative(beyond, T((0.25 * E) / (I * root)), T((beta - 1) * power));
    return {W, where_not_negative(x, dW, T(-dW)), ddW};
  }
};

}  // namespace langer
