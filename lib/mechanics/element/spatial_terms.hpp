// The state of eight points at once in the form that for_each_term() needs, in the deformed state
// (components in the order of voigt.hpp):
//   h  isochoric push-forward of an invariant's tensor, I = tr h: b_bar for I1_bar, kappa b_bar + (1 - 3 kappa) m (F a)(F a)^T for a
//      family of fibres
#pragma once

#include "core/tensor/packet.hpp"
#include "core/tensor/voigt.hpp"
#include "mechanics/material/terms.hpp"

namespace langer {

// direction(k, i): component i of the reference direction of family k
template <class Direction>
struct SpatialState {
  using P = Packet;
  const P* F;
  Direction direction;
  P factor, b[6];

  SpatialState(const P* gradient, const P& J, Direction of) : F(gradient), direction(of) {
    const P root = cbrt(J);
    factor = 1.0 / (root * root);
    for (int p = 0; p < 6; ++p) {
      const int i = voigt_i[p];
      const int j = voigt_j[p];
      b[p] = factor *
             (F[3 * i] * F[3 * j] + F[3 * i + 1] * F[3 * j + 1] + F[3 * i + 2] * F[3 * j + 2]);
    }
  }
  struct Family {
    P h[6], I;
  };
  P I1_bar() const { return b[0] + b[1] + b[2]; }
  const P& m() const { return factor; }
  Family family(const Fibre& fibre, std::size_t k) const {
    P f[3];
    Family out;
    for (int i = 0; i < 3; ++i)
      f[i] = F[3 * i] * direction(k, 0) + F[3 * i + 1] * direction(k, 1) +
             F[3 * i + 2] * direction(k, 2);
    const double along = 1 - 3 * fibre.kappa;
    for (int p = 0; p < 6; ++p)
      out.h[p] = fibre.kappa * b[p] + along * factor * f[voigt_i[p]] * f[voigt_j[p]];
    out.I = out.h[0] + out.h[1] + out.h[2];
    return out;
  }
};

}  // namespace langer
