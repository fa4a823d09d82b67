// The cell of solid.hpp over an increment: the force that does as much work on the way from u0 to
// u1 as the energy of the cell changes, and that has no resultant moment.  [Simo, Tarnow 1992;
// Gonzalez 2000]
//   f = integral B(F_m)^T S dV0,   F_m = (F_0 + F_1) / 2
// As F_m^T (F_1 - F_0) has the symmetric part dE = E_1 - E_0, the force keeps the energy exactly if
// S : dE is the change of W, and it keeps angular momentum because S is symmetric. A stress that
// is evaluated at F_m would not do: a body that turns is compressed there by the cosine of half the
// angle, and near incompressibility that pressure outweighs all else.
//
// S is a discrete gradient of each part of the energy:
//   W_iso   S = mean of 2 dW/dC along the straight line from C_0 to C_1, by three Gauss points
//   J       the same of dJ/dE at each Gauss point, times the pressure
//   U       p = (U_1 - U_0) / (theta_1 - theta_0); of a quadratic U that of the mean dilatation
// The mean along the line needs no quotient. It leaves a defect of the seventh order in dE, below
// rounding in a usual increment. Where the defect is above it (long increments, fibres that turn
// on), Gonzalez' correction takes it away:
//   S + c dE,   c = (W_1 - W_0 - S : dE) / (dE : dE)
// Below it the correction would be rounding error over a vanishing strain increment.
//
// The derivative is not symmetric: B stands with F_m on the left and with F_1 on the right.
#pragma once

#include <span>
#include <vector>

#include "mechanics/element/formulation.hpp"
#include "mechanics/element/geometry.hpp"
#include "mechanics/material/material.hpp"

namespace langer {

struct ConservingElement {
  VecX f;            // [N]; dof 3 a + i: node a, direction i
  MatX K;            // derivative with respect to (u0 + u1) / 2 [N/mm], filled only with a tangent
  double W = 0;      // energy at u1 [N mm]
  double J_min = 0;  // smallest det F at u1
  std::vector<double> J_minus_1;  // mean of both ends: t_k, or J - 1 at each Gauss point
  std::vector<VecX> dJ_du;        // derivatives of those with respect to (u0 + u1) / 2
};

// Elastic laws only. local and p_tangent as in solid(). Returns false if some det F at u1 is not
// positive.
bool conserving_solid(Formulation formulation, const Material& material, double local,
                      const ElementGeometry& geometry, std::span<const Vec3> a,
                      const ElementNodes& u0, const ElementNodes& u1, const double* p_tangent,
                      bool with_tangent, ConservingElement& out);

}  // namespace langer
