// Total Lagrangian cell: internal force and tangent over the reference volume.   [A23] eqs 28-33,
// [SH98]
//   f = integral B^T S dV0,  B = B_L + B_NL(u)
//   K = integral B^T D B dV0 + geometric part
// How the dilatation enters:
//   displacement       W = W_iso(C) + U(J) at every Gauss point (what FER does; locks when 2/d is large)
//   mean_dilatation    U(J_bar) with one J_bar = (1/V) integral J dV0 per element
//   linear_dilatation  U(J_bar) with J_bar linear in X, discontinuous between elements: three-field Hu-Washizu with dilatation and
//                      pressure in {1, X, Y, Z}, condensed (Q2P1 on hex27, its like on tet15; hex8 would lock)                  [SH98]
// With modes m_k orthonormal in the mean over the element (m_0 = 1) the last two are one, for a
// quadratic U:
//   t_k = (1/V) integral m_k (J - 1) dV0,   W_vol = V kappa/2 sum t_k^2,   p = sum m_k kappa t_k;   K stays symmetric
// Another U has W_vol = integral U(1 + sum t_k m_k) dV0 (dilatation.hpp).
// The part of J - 1 that the four modes do not represent has a modulus of its own, `local`, equal
// to the largest compressive pressure of the cell. Reason: displacements h that change J but no t_k
// have the energy p ((tr h)^2 - tr h^2) from the second derivative of J. For p < 0 that varies
// within the cell its first part is destabilising: the cell buckles internally although the body is
// stable [ABLR05]. The modes then have the modulus kappa - local. The tangent may use another
// pressure than kappa (J - 1): p_tangent, as predicted by the last linear solve. J - 1 is computed
// from the displacement gradient, never as det F - 1, which would lose its digits. Returns false if
// some det F is not positive; f and K are then meaningless.
#pragma once

#include <span>
#include <vector>

#include "mechanics/element/formulation.hpp"
#include "mechanics/element/geometry.hpp"
#include "mechanics/element/viscous_points.hpp"
#include "mechanics/material/material.hpp"

namespace langer {

// The number of dilatations of a cell, each with its pressure: t_k, or J - 1 at each Gauss point.
int n_pressures(Formulation f, int n_nodes);
// The modulus `local` [MPa] of a cell of linear_dilatation with the pressures kappa t_k: the
// largest compressive pressure at its Gauss points.
double local_modulus(const ElementGeometry& geometry, const double* p);
// Its derivative if those pressures change by dp: that of the Gauss point with the largest value.
double local_modulus_change(const ElementGeometry& geometry, const double* p, const double* dp);

struct SolidElement {
  VecX f;                         // [N]; dof 3 a + i: node a, direction i
  MatX K;                         // [N/mm], filled only with a tangent
  double W = 0;                   // stored energy [N mm]
  double J_min = 0;               // smallest det F over the Gauss points
  std::vector<double> J_minus_1;  // t_k, or J - 1 at each Gauss point
  std::vector<VecX> dJ_du;        // gradients of those
};

// local: modulus of what the modes leave of J - 1; memory: of viscous branches, none where the law
// is elastic (W is then without them)
bool solid(Formulation formulation, const Material& material, double local,
           const ElementGeometry& geometry, std::span<const Vec3> a, const ElementNodes& u,
           const double* p_tangent, bool with_tangent, SolidElement& out,
           const CellMemory* memory = nullptr);

// State at a Gauss point, for results.
struct GaussState {
  Mat3 F;
  Mat3 sigma;  // Cauchy stress [MPa]
  double J = 1;
  double pressure = 0;  // p or U'(J): the volumetric part of the mean stress [MPa]
};
// branches: sum of the branch stresses Q_i at each Gauss point, empty where the law is elastic
std::vector<GaussState> gauss_states(Formulation formulation, const Material& material,
                                     const ElementGeometry& geometry, std::span<const Vec3> a,
                                     const ElementNodes& u, std::span<const Vec6> branches = {});
double mean_I4_bar(std::span<const GaussState> states,
                   const Vec3& a);  // over the Gauss points, of fibres along a

}  // namespace langer
