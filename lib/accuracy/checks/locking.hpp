// How far a formulation is off where its cells oppose the wrong changes of volume. [SH98]
//   displacement                        too stiff: opposes J - 1 at every Gauss point; what the usual modes leave should be free
//   mean_dilatation of quadratic cells  too soft: opposes its mean alone; the linear modes are free to change and should not be
// theta is the part of J - 1 in question, kappa the bulk modulus, mu the secant 2 W / (I1_bar - 3)
// of the cell's isochoric energy.
//   too stiff   Phi = 1/2 integral kappa theta^2 dV0 is what the stored energy W would lose without moving, so the least that is too
//               much; where shear gives way first, theta is small and its pressure kappa theta tells:
//               forces too large by  Phi / (W - Phi) + 1/2 integral (kappa theta)^2 / (50 mu) dV0 / W
//   too soft    a modulus kappa on theta, against a shear of 2 mu, would store  1/2 integral theta^2 / (1/kappa + 1/(2 mu)) dV0
// 50 and 2 are calibrated: tests/run/locking.cpp has the scenes. Forces and stored energy are taken
// to be off by the same share.
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
