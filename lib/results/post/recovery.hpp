// How far a solution's stress is from a smooth one: the error that it carries itself, without
// another solution.       [ZZ87]
//   s* = the field through the nodal averages of the Cauchy stress (fields.hpp; averages never mix regions)
//   e^2 = sum over Gauss points of  w J |dev(s* - s)|^2 / (4 mu),   U^2 the same of s* itself,   eta = e / U
// mu: shear modulus of the matrix at rest. Both are energies of an incompressible linear material;
// their ratio is that of the stress. In an equilibrium under imposed movements the stored energy
// and with it the force is too large by about eta^2, relatively. What the smooth field cannot see:
// where nodes come into contact one by one, locking, the path's increments.
#pragma once

#include "results/post/nodal_fields.hpp"

namespace langer {

struct RecoveredError {
  double eta = 0;               // relative error of the deviatoric stress, weighted as energy [-]
  double von_mises_max = 0;     // greatest of the nodal averages [MPa]
  double von_mises_spread = 0;  // around it: the greatest difference between a cell and the average
                                // at a node of its cells [MPa]
  std::vector<double> of_cell = {};  // what each cell has of energy_share()
  double energy_share() const { return eta * eta; }
};
RecoveredError recovered_error(const Body& body, const std::vector<Vec3>& u);  // u (n) [mm]
double recovered_energy_share(const Body& body,
                              const std::vector<Vec3>& u);  // of it energy_share() alone

}  // namespace langer
