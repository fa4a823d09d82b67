#include "mechanics/element/conserving_solid.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/tensor/kinematics.hpp"
#include "core/tensor/voigt.hpp"
#include "mechanics/element/point_kinematics.hpp"
#include "mechanics/element/solid.hpp"

namespace langer {

namespace {

struct ChordPoint {
  double s = 0;  // along the line from the beginning (0) to the end (1)
  double weight = 0;
};
const std::array<ChordPoint, 3> chord_points{
    {{0.5 - std::sqrt(0.15), 5. / 18}, {0.5, 8. / 18}, {0.5 + std::sqrt(0.15), 5. / 18}}};

// Defects of the mean along the line that are corrected, over the modulus or, of J, over 1: larger
// than rounding, which a correction multiplies by 1 / |dE|. That of J is less, as pressures
// multiply it.
constexpr double least_defect = 2e-12;
constexpr double least_defect_of_J = 2e-14;

// The part of a defect that is corrected: none up to `least`, all of it from twice that on, and
// continuous between, so that Newton's method does not alternate between two forces.
struct Corrected {
  double value = 0;
  double slope = 0;  // d value / d defect
};

Corrected corrected_part(double defect, double least) {
  const double size = std::abs(defect) / least;
  if (!(size > 1)) return {};
  if (size >= 2) return {defect, 1};
  return {defect * (size - 1), 2 * size - 1};
}

// The discrete gradient of a potential of the strain, and its derivative: gradient and dE are
// components and engineering components in the order of voigt.hpp.
//   d(gradient) = derivative e,   e = dE at the middle of the increment = B(F_1) du_m
struct DiscreteGradient {
  Vec6 gradient = Vec6::Zero();
  Mat6 derivative = Mat6::Zero();
};

// Makes gradient : dE the change of the potential. at_end: its gradient at the end.
void correct_gradient(DiscreteGradient& of, double change, const Vec6& at_end, const Mat3& dE,
                      double least, bool with_tangent) {
  const Vec6 components = voigt(dE);
  const Vec6 engineering = voigt_strain(dE);
  const double squared = components.dot(engineering);
  if (squared == 0) return;
  const Corrected part = corrected_part(change - of.gradient.dot(engineering), least);
  if (part.slope == 0) return;
  const double c = part.value / squared;
  if (with_tangent) {
    const Vec6 d_defect = 2 * (at_end - of.gradient) - of.derivative.transpose() * engineering;
    const Vec6 dc = (part.slope * d_defect - 4 * c * components) / squared;
    of.derivative += components * dc.transpose();
    for (int p = 0; p < 6; ++p) of.derivative(p, p) += p < 3 ? 2 * c : c;
  }
  of.gradient += c * components;
}

// The difference quotient of U between two dilatations, and its derivative with respect to the
// second one.
struct VolumeQuotient {
  double p = 0, dp = 0;  // [MPa]
};

VolumeQuotient volume_quotient(const Volume& law, double x0, double x1) {
  VolumeQuotient out;
  for (const ChordPoint& point : chord_points) {
    const Energy<double> U = volume_energy(law, x0 + point.s * (x1 - x0));
    out.p += point.weight * U.dW;
    out.dp += point.weight * point.s * U.ddW;
  }
  if (linear_pressure(law)) return out;
  const Energy<double> U1 = volume_energy(law, x1);
  const double dx = x1 - x0;
  const double defect = U1.W - volume_energy(law, x0).W - out.p * dx;
  const Corrected part = corrected_part(defect, least_defect * bulk_modulus(law));
  if (part.slope == 0) return out;
  const double d_defect = U1.dW - out.p - dx * out.dp;
  out.p += part.value / dx;
  out.dp += (part.slope * d_defect - part.value / dx) / dx;
  return out;
}

// Pressures of the dilatation modes over an increment, with their derivatives with respect to the
// modes at its end, and the energy there.
struct ModalQuotient {
  std::array<double, n_modes> p{};                           // [MPa]
  std::array<std::array<double, n_modes>, n_modes> kappa{};  // [MPa]
  double W = 0;                                              // [N mm]
};

ModalQuotient modal_quotient(const Volume& law, int n_p, const double* t0, const double* t1,
                             double local, const ElementGeometry& geometry) {
  ModalQuotient out;
  const int n_points = n_p == 1 ? 1 : geometry.n_gauss();
  for (int g = 0; g < n_points; ++g) {
    const double share = n_p == 1 ? 1 : geometry.w[g] / geometry.V;
    double x0 = 0, x1 = 0;
    for (int k = 0; k < n_p; ++k) {
      x0 += dilatation_mode(geometry, g, k) * t0[k];
      x1 += dilatation_mode(geometry, g, k) * t1[k];
    }
    const VolumeQuotient q = volume_quotient(law, x0, x1);
    out.W += geometry.V * share * volume_energy(law, x1).W;
    for (int k = 0; k < n_p; ++k) {
      const double weight = share * dilatation_mode(geometry, g, k);
      out.p[k] += weight * q.p;
      for (int l = 0; l < n_p; ++l)
        out.kappa[k][l] += weight * dilatation_mode(geometry, g, l) * q.dp;
    }
  }
  // The bubble modulus has its share of the modes (solid.hpp).
  for (int k = 0; k < n_p; ++k) {
    out.W -= 0.5 * local * geometry.V * t1[k] * t1[k];
    out.p[k] -= 0.5 * local * (t0[k] + t1[k]);
    out.kappa[k][k] -= 0.5 * local;
  }
  return out;
}

// Both discrete gradients at one Gauss point.
struct PointIncrement {
  DiscreteGradient iso, J;
  double W = 0;  // isochoric energy at the end [MPa]
  Vec6 dJ_end;   // dJ/dE at the end
};

PointIncrement point_increment(const Material& material, std::span<const Vec3> a, const Mat3& F0,
                               const Mat3& F1, double x0, double x1, const Mat3& dE,
                               bool with_tangent) {
  PointIncrement out;
  const Mat3 C0 = F0.transpose() * F0;
  const Mat3 C1 = F1.transpose() * F1;
  for (const ChordPoint& point : chord_points) {
    const Mat3 C = C0 + (2 * point.s) * dE;
    const Response iso = isochoric(material, C, a, with_tangent);
    const double J = std::sqrt(C.determinant());
    const Mat3 C_inverse = C.inverse();
    const Vec6 Ci = voigt(C_inverse);
    out.iso.gradient += point.weight * iso.S;
    out.J.gradient += point.weight * J * Ci;
    if (!with_tangent) continue;
    // the strain at s changes by 2 s e where that of the middle changes by e
    const double share = 2 * point.s * point.weight;
    out.iso.derivative += share * iso.D;
    out.J.derivative += share * J * (Ci * Ci.transpose() - 2 * symmetric_product(C_inverse));
  }
  const Response start = isochoric(material, C0, a, false);
  const Response end = isochoric(material, C1, a, false);
  out.W = end.W;
  out.dJ_end = (1 + x1) * voigt(Mat3(C1.inverse()));
  const double modulus = std::max({std::abs(shear_modulus(material)), start.W, end.W});
  correct_gradient(out.iso, end.W - start.W, end.S, dE, least_defect * modulus, with_tangent);
  correct_gradient(out.J, x1 - x0, out.dJ_end, dE, least_defect_of_J, with_tangent);
  return out;
}

template <int n>
bool conserving_of(Formulation formulation, const Material& material, double local,
                   const ElementGeometry& geometry, std::span<const Vec3> a, const ElementNodes& u0,
                   const ElementNodes& u1, const double* p_tangent, bool with_tangent,
                   ConservingElement& out) {
  using Vec = typename Sizes<n>::Vec;
  using Strain = typename Sizes<n>::Strain;
  const bool modal = formulation != Formulation::displacement;
  const int n_gauss = geometry.n_gauss();
  const int n_p = n_pressures(formulation, n);
  const GaussPoints<n> start(geometry, u0);
  const GaussPoints<n> end(geometry, u1);
  out.J_min = end.J_min;
  if (!(out.J_min > 0) || !(start.J_min > 0)) return false;

  // Dilatations at both ends; the derivative of their mean is the gradient at the end.
  out.J_minus_1.assign(n_p, 0);
  out.dJ_du.assign(n_p, VecX::Zero(3 * n));
  std::array<double, n_modes> t0{}, t1{};
  for (int k = 0; k < n_p; ++k) {
    if (!modal) {
      out.J_minus_1[k] = 0.5 * (start.J_minus_1[k] + end.J_minus_1[k]);
      out.dJ_du[k] = end.dJ[k];
      continue;
    }
    for (int g = 0; g < n_gauss; ++g) {
      const double share = geometry.w[g] * dilatation_mode(geometry, g, k) / geometry.V;
      t0[k] += share * start.J_minus_1[g];
      t1[k] += share * end.J_minus_1[g];
      out.dJ_du[k] += share * end.dJ[g];
    }
    out.J_minus_1[k] = 0.5 * (t0[k] + t1[k]);
  }
  ModalQuotient volume;
  if (modal) volume = modal_quotient(material.volume, n_p, t0.data(), t1.data(), local, geometry);
  out.W = volume.W;

  const ElementNodes moved = u1 - u0;
  Vec f = Vec::Zero();
  std::array<Vec, n_modes> middle;  // V times the discrete gradient of each mode
  for (Vec& b : middle) b.setZero();
  thread_local typename Sizes<n>::Mat K;
  if (with_tangent) K.setZero();
  for (int g = 0; g < n_gauss; ++g) {
    const double w = geometry.w[g];
    const double x0 = start.J_minus_1[g];
    const double x1 = end.J_minus_1[g];
    const Mat3 F_middle = 0.5 * (start.F[g] + end.F[g]);
    const Mat3 dF = displacement_gradient(moved, geometry.dN_dX[g]);
    const Mat3 F_dF = F_middle.transpose() * dF;
    const Mat3 dE = 0.5 * (F_dF + F_dF.transpose());
    const PointIncrement at =
        point_increment(material, a, start.F[g], end.F[g], x0, x1, dE, with_tangent);
    out.W += w * at.W;

    // Pressure of the point itself: U of the displacement formulation, or that of the bubble.
    VolumeQuotient own;
    if (modal) {
      own = {0.5 * local * (x0 + x1), 0.5 * local};
      out.W += 0.5 * w * local * x1 * x1;
    } else {
      own = volume_quotient(material.volume, x0, x1);
      out.W += w * volume_energy(material.volume, x1).W;
    }
    double p = own.p;
    double p_K = own.p;
    if (!modal && p_tangent) p_K = p_tangent[g];
    for (int k = 0; k < n_p && modal; ++k) {
      const double mode = dilatation_mode(geometry, g, k);
      p += mode * volume.p[k];
      p_K += mode * (p_tangent ? p_tangent[k] : volume.p[k]);
    }
    const Strain B = strain_operator<n>(F_middle, start.dN[g]);
    f.noalias() += w * (B.transpose() * (at.iso.gradient + p * at.J.gradient));
    if (!with_tangent) continue;
    for (int k = 0; k < n_p && modal; ++k) {
      middle[k].noalias() +=
          (w * dilatation_mode(geometry, g, k)) * (B.transpose() * at.J.gradient);
    }
    Mat6 D = at.iso.derivative + p_K * at.J.derivative;
    if (own.dp != 0) D += (2 * own.dp) * at.J.gradient * at.dJ_end.transpose();
    const Strain DB = w * D * strain_operator<n>(end.F[g], start.dN[g]);
    K.noalias() += B.transpose() * DB;
    add_geometric<n>(start.dN[g], at.iso.gradient + p_K * at.J.gradient, w, K);
  }
  if (with_tangent && modal) {
    for (int k = 0; k < n_p; ++k) {
      for (int l = 0; l < n_p; ++l) {
        if (volume.kappa[k][l] == 0) continue;
        K.noalias() += (2 * volume.kappa[k][l] * middle[k]) * out.dJ_du[l].transpose();
      }
    }
  }
  out.f = f;
  if (with_tangent) out.K = K;
  return true;
}

}  // namespace

bool conserving_solid(Formulation formulation, const Material& material, double local,
                      const ElementGeometry& geometry, std::span<const Vec3> a,
                      const ElementNodes& u0, const ElementNodes& u1, const double* p_tangent,
                      bool with_tangent, ConservingElement& out) {
  bool done = false;
  with_cell(static_cast<int>(u0.rows()), [&](auto cell) {
    done = conserving_of<decltype(cell)::n_nodes>(formulation, material, local, geometry, a, u0, u1,
                                                  p_tangent, with_tangent, out);
  });
  return done;
}

}  // namespace langer
