// The state of a body in motion at the end of an increment, in addition to its displacements:
// velocities and accelerations, what the time scheme carries on (dynamics/inertia.hpp), and
// energies. A stopped run continues from it with the same digits, so the solution file keeps it.
#pragma once

#include "core/tensor/types.hpp"

namespace langer {

struct MotionState {
  VecX v, a;  // (3 n) velocity [mm/s], acceleration [mm/s2]; empty: without inertia
  // (3 n) what its scheme carries on: the averaged acceleration of generalised_alpha [mm/s2], the
  // force without reactions of theta [N]
  VecX b;
  VecX reactions;  // (3 n) of supports and contacts in the increment [N]
  // of an indenter with mass, along its direction
  double travel_v = 0, travel_a = 0, travel_b = 0;
  // [N mm]
  double kinetic = 0, stored = 0;
  double total = 0;    // kinetic, stored, against viscous branches, lost to Rayleigh's damping
  double damped = 0;   // by Rayleigh's damping since the beginning
  double balance = 0;  // change of `total` since the beginning without the work done from outside
  double error = 0;    // of the increment

  bool present() const { return v.size() > 0; }
};

}  // namespace langer
