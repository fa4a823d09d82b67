// The error of a solution's stress from that solution alone: the difference to a smooth stress.
// [ZZ87]
//   s*    the field through the nodal averages of the Cauchy stress (post/nodal_fields.hpp), which
//         never mix regions
//   e^2 = sum over Gauss points of  w J |dev(s* - s)|^2 / (4 mu),   U^2 the same of s* itself
//   eta = e / U
// mu is the shear modulus of the matrix at rest. e^2 and U^2 are energies of an incompressible
// linear material, so eta is the relative error of the deviatoric stress. In an equilibrium under
// imposed displacements the stored energy, and with it the force, is too large by about eta^2
// (relative). The estimate does not include errors that the smooth field has too: nodes that come
// into contact one by one, locking, and the increments of the path.
#pragma once

#include "results/post/nodal_fields.hpp"

namespace langer {

// The estimate and the parts that reports show.
struct RecoveredError {
  double eta = 0;            // relative error of the deviatoric stress, weighted as energy [-]
  double von_mises_max = 0;  // greatest of the nodal averages [MPa]
  // The greatest difference between an element and the average, at the nodes around the node of
  // von_mises_max [MPa].
  double von_mises_spread = 0;
  std::vector<double> of_cell = {};  // the part of each element in energy_share()
  double energy_share() const { return eta * eta; }
};
RecoveredError recovered_error(const Body& body, const std::vector<Vec3>& u);  // u (n) [mm]
// energy_share() alone, which is cheaper.
double recovered_energy_share(const Body& body, const std::vector<Vec3>& u);

}  // namespace langer
