#include "accuracy/checks/locking.hpp"

#include <algorithm>
#include <cmath>

#include "core/tensor/kinematics.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

namespace {

constexpr double by_shear_if_stiff = 50, by_shear_if_soft = 2;  // calibrated

struct CellSums {
  double theta2 = 0;     // integral of theta^2 [mm^3]
  double W = 0, I1 = 0;  // of the isochoric energy and of I1_bar - 3
};

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
    out.W += w * isochoric(body.material(e), C, body.fibres(e), false).W;
    out.I1 += w * (C.trace() / std::cbrt((1 + x) * (1 + x)) - 3);
  }
  for (int g = 0; g < n; ++g) {
    double of_modes = 0;
    const int first = too_soft ? 1 : 0;
    const int end = modal ? n_modes : 1;
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

bool may_lock(Formulation formulation, CellType type) {
  return formulation == Formulation::displacement ||
         (formulation == Formulation::mean_dilatation && reference(type).second_order());
}

Locking locking(const Assembler& body, const VecX& u) {
  Locking out;
  out.energy = body.W();
  const bool too_soft = body.formulation() == Formulation::mean_dilatation;
  double stored = 0, by_pressure = 0, missing = 0, most = 0;
  for (int e = 0; e < body.mesh().n_cells(); ++e) {
    const CellSums cell = sums(body, u, e);
    const double kappa = bulk_modulus(body.material(e));
    const double at_rest = std::abs(shear_modulus(body.material(e)));
    const double mu =
        std::max(cell.I1 > 1e-9 * body.geometry(e).V ? 2 * cell.W / cell.I1 : 0, at_rest);
    const double phi = 0.5 * kappa * cell.theta2;
    const double pressure = phi * kappa / (by_shear_if_stiff * mu);
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
  if (!(out.energy > 0) || most == 0) return out;
  if (too_soft) {
    out.share = -missing / (out.energy + missing);
  } else {
    out.share = stored / std::max(out.energy - stored, 1e-300) + by_pressure / out.energy;
  }
  return out;
}

}  // namespace langer
