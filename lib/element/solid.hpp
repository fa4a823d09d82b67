// Total Lagrangian hexahedron: internal force and tangent over the reference volume.   [A23] eqs 28-33, [SH98]
//   f = integral B^T S dV0,  B = B_L + B_NL(u)
//   K = integral B^T D B dV0 + geometric part
// Two ways for the dilatation to enter:
//   displacement      W = W_iso(C) + U(J) at every Gauss point (what FER does; locks when 2/d is large)
//   mean_dilatation   U(J_bar) with one J_bar = (1/V) integral J dV0 per element (default); K stays symmetric
// The tangent may use another pressure than kappa (J - 1): p_tangent, the one the last linear solve predicted.
// J - 1 is formed from the displacement gradient, never as det F - 1.
// Refuses (returns false) where some det F is not positive; f and K are then meaningless.
#pragma once

#include <array>
#include <span>

#include "base/fields.hpp"
#include "element/geometry.hpp"
#include "material/material.hpp"

namespace langer {

enum class Formulation { mean_dilatation, displacement };
constexpr auto names(Formulation) { return std::array{"mean_dilatation", "displacement"}; }
constexpr int n_pressures(Formulation f) { return f == Formulation::mean_dilatation ? 1 : Hex8::n_gauss; }

using Vec24 = Eigen::Matrix<double, 24, 1>;  // dof 3 a + i: node a, direction i
using Mat24 = Eigen::Matrix<double, 24, 24>;

struct SolidElement {
  Vec24 f;                          // [N]
  Mat24 K;                          // [N/mm], filled only with a tangent
  double W = 0;                     // stored energy [N mm]
  double J_min = 0;                 // smallest det F over the Gauss points
  std::array<double, 8> J_minus_1;  // of J_bar (first entry), or of J at each Gauss point
  std::array<Vec24, 8> dJ_du;       // gradients of those
};

bool solid(Formulation formulation, const Material& material, const ElementGeometry& geometry, std::span<const Vec3> a,
           const ElementNodes& u, const double* p_tangent, bool with_tangent, SolidElement& out);

// State at a Gauss point, for results.
struct GaussState {
  Mat3 F;
  Mat3 sigma;  // Cauchy stress [MPa]
  double J = 1;
  double pressure = 0;  // kappa (J_bar - 1) or kappa (J - 1): the volumetric part of the mean stress [MPa]
};
std::array<GaussState, 8> gauss_states(Formulation formulation, const Material& material, const ElementGeometry& geometry,
                                       std::span<const Vec3> a, const ElementNodes& u);

}  // namespace langer
