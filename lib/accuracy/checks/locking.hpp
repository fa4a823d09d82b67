// How much a formulation falsifies the forces, because its cells resist the wrong changes of
// volume.                                                                               [SH98]
//   displacement                        too stiff: resists J - 1 at every Gauss point, also its
//                                       part theta, which the usual formulation leaves free
//   mean_dilatation of quadratic cells  too soft: resists the mean of J - 1 only, and leaves its
//                                       linear part theta free
// With the bulk modulus kappa, the stored energy W, and the secant shear modulus
// mu = 2 W_iso / (I1_bar - 3) of each cell, at least that at rest:
//   too stiff   the energy  Phi = 1/2 integral kappa theta^2 dV0  is too much. Where shear yields
//               before the volume does, theta is small, but its pressure kappa theta is not. Share:
//               Phi / (W - Phi) + 1/2 integral (kappa theta)^2 / (50 mu) dV0 / W
//   too soft    kappa in series with a shear of 2 mu would store
//               1/2 integral theta^2 / (1/kappa + 1/(2 mu)) dV0
// 50 and 2 are calibrated on the scenes of tests/run/locking.cpp. Forces are taken to be off by the
// same share as the energy.
#pragma once

#include "mechanics/assembly/assembler.hpp"

namespace langer {

bool may_lock(Formulation formulation, CellType type);

struct Locking {
  double share = 0;           // by which the forces are off; negative: too small
  double energy = 0;          // stored [N mm]
  Vec3 place = Vec3::Zero();  // centre of the cell that has most of it
};
Locking locking(const Assembler& body, const VecX& u);

}  // namespace langer
