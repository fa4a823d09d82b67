#include "element/solid.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

#include "tensor/kinematics.hpp"
#include "tensor/voigt.hpp"

namespace langer {

namespace {

using Mat6x24 = Eigen::Matrix<double, 6, 24>;

// dE = B du, engineering shear: row p = ij of node a, direction k is F_ki dN_j + F_kj dN_i
Mat6x24 strain_operator(const Mat3& F, const Hex8::Gradient& dN) {
  Mat6x24 B;
  for (int a = 0; a < 8; ++a)
    for (int k = 0; k < 3; ++k)
      for (int p = 0; p < 6; ++p) {
        const int i = voigt_i[p], j = voigt_j[p];
        B(p, 3 * a + k) = p < 3 ? F(k, i) * dN(a, i) : F(k, i) * dN(a, j) + F(k, j) * dN(a, i);
      }
  return B;
}

// dJ/du of one point: cofactor of F contracted with grad(du)
Vec24 dilatation_gradient(const Mat3& F, const Hex8::Gradient& dN) {
  Mat3 cof;
  cof.col(0) = F.col(1).cross(F.col(2));
  cof.col(1) = F.col(2).cross(F.col(0));
  cof.col(2) = F.col(0).cross(F.col(1));
  const Eigen::Matrix<double, 8, 3> g = dN * cof.transpose();
  Vec24 v;
  for (int a = 0; a < 8; ++a)
    for (int i = 0; i < 3; ++i) v[3 * a + i] = g(a, i);
  return v;
}

void add_geometric(const Hex8::Gradient& dN, const Vec6& S, double w, Mat24& K) {
  const Eigen::Matrix<double, 8, 8> G = w * (dN * tensor(S) * dN.transpose());
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b < 8; ++b)
      for (int i = 0; i < 3; ++i) K(3 * a + i, 3 * b + i) += G(a, b);
}

}  // namespace

bool solid(Formulation formulation, const Material& material, const ElementGeometry& geometry, std::span<const Vec3> a,
           const ElementNodes& u, const double* p_tangent, bool with_tangent, SolidElement& out) {
  const double kappa = material.volume.quadratic.bulk_modulus();
  const bool mean = formulation == Formulation::mean_dilatation;
  out.f.setZero();
  if (with_tangent) out.K.setZero();
  out.W = 0;

  std::array<Mat3, 8> F;
  std::array<double, 8> J_minus_1;
  std::array<Vec24, 8> dJ;
  out.J_min = 1e300;
  for (int g = 0; g < 8; ++g) {
    const Mat3 H = u.transpose() * geometry.dN_dX[g];
    F[g] = Mat3::Identity() + H;
    J_minus_1[g] = volume_change(H);
    out.J_min = std::min(out.J_min, 1 + J_minus_1[g]);
    dJ[g] = dilatation_gradient(F[g], geometry.dN_dX[g]);
  }
  if (!(out.J_min > 0)) return false;

  double p = 0, p_K = 0;  // of the mean dilatation
  if (mean) {
    double theta = 0;
    Vec24 b = Vec24::Zero();
    for (int g = 0; g < 8; ++g) {
      theta += geometry.w[g] * J_minus_1[g];
      b += geometry.w[g] * dJ[g];
    }
    theta /= geometry.V, b /= geometry.V;
    p = kappa * theta, p_K = p_tangent ? *p_tangent : p;
    out.J_minus_1[0] = theta, out.dJ_du[0] = b;
    out.W += 0.5 * geometry.V * p * theta;
    out.f += (geometry.V * p) * b;
    if (with_tangent) out.K += (geometry.V * kappa) * b * b.transpose();
  } else {
    out.J_minus_1 = J_minus_1, out.dJ_du = dJ;
  }

  for (int g = 0; g < 8; ++g) {
    const double w = geometry.w[g], J = 1 + J_minus_1[g];
    const Mat3 C = F[g].transpose() * F[g];
    Response iso = isochoric(material, C, a);
    out.W += w * iso.W;
    const Mat3 C_inverse = C.inverse();
    const Vec6 Ci = voigt(C_inverse);
    Vec6 S = iso.S;
    if (!mean) {
      p = kappa * J_minus_1[g], p_K = p_tangent ? p_tangent[g] : p;
      out.W += 0.5 * w * p * J_minus_1[g];
      S += p * J * Ci;
    }
    const Mat6x24 B = strain_operator(F[g], geometry.dN_dX[g]);
    out.f.noalias() += w * (B.transpose() * S);
    if (!with_tangent) continue;
    // dJ/dE = J C^-1,  d2J/dE2 = J (C^-1 x C^-1 - 2 C^-1 o C^-1)
    Mat6 D = iso.D + p_K * J * (Ci * Ci.transpose() - 2 * symmetric_product(C_inverse));
    if (!mean) D += kappa * J * J * Ci * Ci.transpose();
    const Mat6x24 DB = w * D * B;
    out.K.noalias() += B.transpose() * DB;
    add_geometric(geometry.dN_dX[g], iso.S + p_K * J * Ci, w, out.K);
  }
  return true;
}

std::array<GaussState, 8> gauss_states(Formulation formulation, const Material& material, const ElementGeometry& geometry,
                                       std::span<const Vec3> a, const ElementNodes& u) {
  const double kappa = material.volume.quadratic.bulk_modulus();
  std::array<GaussState, 8> states;
  double theta = 0;
  for (int g = 0; g < 8; ++g) {
    const Mat3 H = u.transpose() * geometry.dN_dX[g];
    states[g].F = Mat3::Identity() + H;
    const double J_minus_1 = volume_change(H);
    states[g].J = 1 + J_minus_1;
    states[g].pressure = kappa * J_minus_1;
    theta += geometry.w[g] * J_minus_1 / geometry.V;
  }
  for (GaussState& s : states) {
    if (formulation == Formulation::mean_dilatation) s.pressure = kappa * theta;
    const Vec6 S = isochoric(material, s.F.transpose() * s.F, a).S;
    s.sigma = s.F * tensor(S) * s.F.transpose() / s.J + s.pressure * Mat3::Identity();
  }
  return states;
}

}  // namespace langer
