// Domains of the energies. If an energy does not exist at a value of its invariant, or would
// overflow, the invariant is replaced by NaN before the energy is evaluated. All results are then
// NaN, without an invalid operation or an overflow on the way, and the state is refused like any
// other that is not finite.
#pragma once

#include <cmath>
#include <limits>

#include "core/tensor/packet.hpp"
#include "mechanics/material/exp_pow_fibre.hpp"
#include "mechanics/material/gent.hpp"
#include "mechanics/material/hgo_fibre.hpp"
#include "mechanics/material/logarithmic_volume.hpp"
#include "mechanics/material/simo_taylor_volume.hpp"

namespace langer {

// The largest c2 (I4_bar - 1)^2: forces of exp(300) = 2e130 and their squares are still finite.
constexpr double largest_exponent = 300;

inline bool exists(const HgoFibre& fibre, double I4_bar) {
  return !std::isgreater(std::sqrt(fibre.c2) * std::abs(I4_bar - 1), std::sqrt(largest_exponent));
}
inline bool exists(const ExpPowFibre& fibre, double I4_bar) {
  if (fibre.alpha == 0)
    return !std::isgreater(std::abs(I4_bar - 1), std::pow(1e150, 1 / fibre.beta));
  return !std::isgreater(std::abs(I4_bar - 1),
                         std::pow(largest_exponent / fibre.alpha, 1 / fibre.beta));
}
inline bool exists(const LogarithmicVolume&, double J_minus_1) {
  return std::isgreater(J_minus_1, -1);
}
inline bool exists(const SimoTaylorVolume&, double J_minus_1) {
  return std::isgreater(J_minus_1, -1);
}
inline bool exists(const Gent& law, double I1_bar) {
  return !std::isgreaterequal(I1_bar - 3, law.Jm);
}

// The largest stretch of a test: its invariants and their powers are still finite.
constexpr double largest_stretch = 1e20;
inline bool possible_stretch(double lambda) {
  return std::isgreater(lambda, 1 / largest_stretch) && std::isless(lambda, largest_stretch);
}

// invariant: of the term; J - 1 of a law of volume change
template <class Law>
double nan_outside_domain(const Law& law, double invariant) {
  if constexpr (requires { exists(law, invariant); }) {
    if (exists(law, invariant)) return invariant;
    return std::numeric_limits<double>::quiet_NaN();
  } else
    return invariant;
}

template <class Law>
Packet nan_outside_domain(const Law& law, Packet invariant) {
  if constexpr (requires { exists(law, 0.0); })
    for (int i = 0; i < Packet::lanes; ++i) invariant.set(i, nan_outside_domain(law, invariant[i]));
  return invariant;
}

}  // namespace langer
