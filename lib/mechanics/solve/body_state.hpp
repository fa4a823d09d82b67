// The state of a body, complete enough to continue from.
#pragma once

#include "mechanics/contact/adhesion.hpp"
#include "mechanics/dynamics/motion_state.hpp"
#include "mechanics/solve/bonds.hpp"
#include "mechanics/solve/contact_state.hpp"

namespace langer {

struct BodyState {
  double t = 0;
  VecX u;  // (3 n) [mm]
  Reactions r;
  double travel = 0;      // of the indenter under force control [mm]
  BondStates bonds = {};  // empty where nothing adheres
  BondEnergy in_bonds = {};
  VecX pressures = {};      // of loads with a given volume [MPa]
  MotionState motion = {};  // empty without inertia
};

// The body before its first increment: t, travel, displacements, pressures and reactions are 0.
// Sizes, bonds and motion are those of `shape`.
BodyState at_rest(BodyState shape);

}  // namespace langer
