// Stresses of a test whose deformation does not depend on the parameters of the law. This holds
// where the test imposes it, and in uniaxial tests along all fibres, whose width and thickness are
// equal by symmetry.
//
// A stress is then linear in the derivatives of the energy terms, with coefficients that depend on
// the deformation alone:
//   stress_i = sum_t W_t'(I_t,i) c_t,i,   c_t,i from  S = 2 dI_t/dC
// A fit evaluates thousands of laws in the same states. Invariants and coefficients are computed
// once; each law costs its W' only, eight points at once. Values are those of model_stress() to
// rounding.
#pragma once

#include <optional>
#include <vector>

#include "core/tensor/packet.hpp"
#include "identification/fit/test_data.hpp"

namespace langer {

class ImposedStates {
 public:
  // nothing where the deformation depends on the law, or the stress on more than W': laws of the
  // stretches and tests with a past
  static std::optional<ImposedStates> of(const Material& law, const Test& test);

  // whether these are the states of a law as well: its fibres point where those of the first did
  bool hold_for(const Material& law) const;

  // stresses of a law [MPa] in the order of model_stress(); false where a state does not exist
  bool stress(const Material& law, double* stress) const;

 private:
  // of eight points; the last ones repeat the last point
  struct Points {
    Packet I1, I2;
    std::vector<Packet> I4;  // of each family
    // of the stress along x (or the shear stress) and along z: coefficients of the matrix terms of
    // I1_bar and I2_bar, and of each family's M = a a^T
    struct Coefficients {
      Packet of_I1, of_I2;
      std::vector<Packet> of_I4;
    };
    Coefficients x, z;
  };
  class State;

  std::vector<Points> points_;
  std::vector<double> alpha_deg_;
  std::size_t n_points_ = 0;
  bool has_z_ = false, exist_ = true;
};

}  // namespace langer
