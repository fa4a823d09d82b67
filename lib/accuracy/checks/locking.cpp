#include "accuracy/checks/locking.hpp"

#include <algorithm>
#include <cmath>

#include "core/tensor/kinematics.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

namespace {

// A volume change that the cells cannot follow is partly met by shear. The two factors scale the
// shear modulus in the estimates of a cell that is too stiff and of one that is too soft.
constexpr double by_shear_if_stiff = 50, by_shear_if_soft = 2;  // calibrated

// Integrals over one cell at rest. theta is the part of the volume change J - 1 that decides on
// locking; the other two give the secant shear modulus of the present state.
struct CellSums {
  double theta2 = 0;     // integral of theta^2 [mm^3]
  double W = 0, I1 = 0;  // of the isochoric energy and of I1_bar - 3
};

// The volume change of a cell is expanded in its modes: the constant and, where the geometry has
// them, the others. A displacement formulation also stores energy in what is outside these modes,
// which makes it too stiff. A mean dilatation stores none in the modes above the constant, which
// makes it too soft. theta is the part that is wrong in either case.
CellSums sums(const Assembler& body, const VecX& u, int e) {
  const ElementGeometry& geometry = body.geometry(e);
  const ElementNodes q = body.element_displacements(u, e);
  const int n = geometry.n_gauss();
  const bool modal = !geometry.mode.empty();
  const bool too_soft = body.formulation() == Formulation::mean_dilatation;
  CellSums out;
  std::vector<double> J_minus_1(n);
  std::array<double, n_modes> t{};
  for (int g = 0; g < n; ++g) {
    const Mat3 H = displacement_gradient(q, geometry.dN_dX[g]);
    const Mat3 F = Mat3::Identity() + H;
    const double w = geometry.w[g];
    const double x = J_minus_1[g] = volume_change(H);
    for (int k = 0; k < (modal ? n_modes : 1); ++k)
      t[k] += w * x * (k == 0 ? 1 : geometry.mode[g][k]) / geometry.V;
    const Mat3 C = F.transpose() * F;
    // I1_bar = J^(-2/3) tr C has no share of the volume change, and neither has the isochoric
    // energy.
    out.W += w * isochoric(body.material(e), C, body.fibres(e), false).W;
    out.I1 += w * (C.trace() / std::cbrt((1 + x) * (1 + x)) - 3);
  }
  for (int g = 0; g < n; ++g) {
    double of_modes = 0;
    const int first = too_soft ? 1 : 0;
    const int end = modal ? n_modes : 1;
    // The modes are orthogonal, so a point's value of the expansion is the sum of its coefficients
    // times the modes there. Mode 0 is the constant 1.
    for (int k = first; k < end; ++k) of_modes += t[k] * (k == 0 ? 1 : geometry.mode[g][k]);
    double theta = 0;
    if (too_soft) {
      theta = of_modes;
    } else {
      theta = J_minus_1[g] - of_modes;
    }
    out.theta2 += geometry.w[g] * theta * theta;
  }
  return out;
}

}  // namespace

// A mean dilatation is the right choice in cells of first order, which have only the constant mode.
// In cells of second order it leaves out modes, and the result may be too soft.
bool may_lock(Formulation formulation, CellType type) {
  return formulation == Formulation::displacement ||
         (formulation == Formulation::mean_dilatation && reference(type).second_order());
}

// The share of the energy that is an artefact of the formulation: positive where the body is too
// stiff, negative where it is too soft. The place is the middle of the cell with the largest part.
Locking locking(const Assembler& body, const VecX& u) {
  Locking out;
  out.energy = body.W();
  const bool too_soft = body.formulation() == Formulation::mean_dilatation;
  double stored = 0, by_pressure = 0, missing = 0, most = 0;
  for (int e = 0; e < body.mesh().n_cells(); ++e) {
    const CellSums cell = sums(body, u, e);
    const double kappa = bulk_modulus(body.material(e));
    const double at_rest = std::abs(shear_modulus(body.material(e)));
    // The secant modulus of the neo-Hookean law W = mu / 2 (I1_bar - 3), at least the modulus at
    // rest. A cell that is almost undeformed has the modulus at rest alone: 0 / 0 would be noise.
    const double mu =
        std::max(cell.I1 > 1e-9 * body.geometry(e).V ? 2 * cell.W / cell.I1 : 0, at_rest);
    const double phi = 0.5 * kappa * cell.theta2;
    // Where shear gives way first, theta is small, but its pressure kappa theta still changes the
    // forces. The estimate of this energy grows with kappa / mu: a nearly incompressible solid
    // locks most.
    const double pressure = phi * kappa / (by_shear_if_stiff * mu);
    // The missing energy is that of two springs in series: the volume resists with kappa and the
    // shear by which the cell would avoid the volume change with a multiple of mu.
    const double soft = 0.5 * cell.theta2 / (1 / kappa + 1 / (by_shear_if_soft * mu));
    stored += phi;
    by_pressure += pressure;
    missing += soft;
    double here = 0;
    if (too_soft) {
      here = soft;
    } else {
      here = phi + pressure;
    }
    if (here <= most) continue;
    most = here;
    out.place.setZero();
    for (int a : body.mesh().cell(e))
      out.place += body.mesh().X[a] / static_cast<double>(body.mesh().cell(e).size());
  }
  // At rest there is no energy to compare with, and the share remains 0.
  if (!(out.energy > 0) || most == 0) return out;
  if (too_soft) {
    out.share = -missing / (out.energy + missing);
  } else {
    // The energy without the artefact is in the denominator; the tiny number prevents a division by
    // 0 where all the energy is artefact.
    out.share = stored / std::max(out.energy - stored, 1e-300) + by_pressure / out.energy;
  }
  return out;
}

}  // namespace langer
