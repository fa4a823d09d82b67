// A fibre family: its law, one of several, and what all of them share. One more law is its header
// and its name in the list.
#pragma once

#include <variant>

#include "core/base/fields.hpp"
#include "mechanics/material/exp_pow_fibre.hpp"
#include "mechanics/material/hgo_fibre.hpp"
#include "mechanics/material/pow_linear_fibre.hpp"

namespace langer {

// Each is an EnergyTerm of I_k (material.hpp), with modulus() [MPa]: at 0 it does nothing.
using FibreLaw = std::variant<HgoFibre, ExpPowFibre, PowLinearFibre>;

enum class FibreSwitch { I4_bar, I4, off };  // off: the fibre also acts in compression
constexpr auto names(FibreSwitch) { return std::array{"I4_bar", "I4", "off"}; }

struct Fibre {
  FibreLaw law;
  double alpha_deg = 0;
  FibreSwitch tension_switch = FibreSwitch::I4_bar;
  double kappa = 0;
  static void fields(auto& v) {
    v(&Fibre::law, among_keys, unit::none, "energy of the fibres, eq. 14", required);
    v(&Fibre::alpha_deg, "alpha", unit::deg,
      "angle between the fibres and the frame's x axis, in the x-z plane, eq. 1",
      between(-360, 360));
    v(&Fibre::tension_switch, "switch", unit::none,
      "which invariant decides that the fibre is stretched; the paper prints I4, eq. 16");
    v(&Fibre::kappa, "kappa", unit::none,
      "dispersion: 0 all fibres along the direction, 1/3 no direction at all", between(0, 1. / 3));
  }
};

// Families whose modulus is 0 keep their place and do nothing.
inline bool acts(const Fibre& family) {
  return std::visit([](const auto& law) { return law.modulus() != 0; }, family.law);
}

}  // namespace langer
