// Eight chains in a cube [AB93], the inverse Langevin function expanded to five terms:
//   W = mu sum_{i=1..5} C_i / L^(2i-2) (I1_bar^i - 3^i),   C = 1/2, 1/20, 11/1050, 19/7000, 519/673750
//   mu [MPa]; L [-] > 0 the stretch at which the chains lock, sqrt of the number of links of a chain
// The shear modulus at rest is mu (1 + 3/(5 L^2) + 99/(175 L^4) + ...), not mu.
#pragma once

#include "core/base/fields.hpp"
#include "core/base/search_bounds.hpp"
#include "mechanics/material/energy.hpp"

namespace langer {

struct ArrudaBoyce {
  static constexpr const char* key = "arruda_boyce";
  static constexpr Invariant of = Invariant::I1_bar;
  double mu = 0, locking_stretch = 1;
  static void fields(auto& v) {
    v(&ArrudaBoyce::mu, "mu", unit::MPa,
      "n k T of the chains: the shear modulus at rest where they are long", required);
    v(&ArrudaBoyce::locking_stretch, "locking_stretch", unit::none,
      "stretch at which the chains are straight", required, positive, SearchBounds{1, 20});
  }
  template <class T>
  Energy<T> operator()(T I1_bar) const {
    constexpr double C[] = {1. / 2, 1. / 20, 11. / 1050, 19. / 7000, 519. / 673750};
    const double shrink = 1 / (locking_stretch * locking_stretch);
    //   I^i - 3^i = (I - 3) sum_{k<i} I^k 3^(i-1-k), which is exactly zero at rest
    T sum = T{} + 1.0;
    T power = T{} + 1.0;
    T W = T{};
    T dW = T{};
    T ddW = T{};
    double c = mu;
    T below = T{};  // I^(i-2)
    for (int i = 1; i <= 5; ++i, c *= shrink) {
      W += c * C[i - 1] * sum;
      dW += c * C[i - 1] * i * power;
      ddW += c * C[i - 1] * (i * (i - 1.)) * below;
      below = power;
      power = power * I1_bar;
      sum = 3.0 * sum + power;
    }
    return {(I1_bar - 3.0) * W, dW, ddW};
  }
};

}  // namespace langer
