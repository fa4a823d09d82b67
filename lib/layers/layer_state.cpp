#include "layers/layer_state.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "core/tensor/kinematics.hpp"
#include "core/tensor/principal.hpp"
#include "core/tensor/push_forward.hpp"
#include "core/tensor/stress.hpp"
#include "mechanics/material/existence.hpp"

namespace langer {

namespace {

constexpr int voigt_of[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

// c of symmetric strains as moduli of all displacement gradients
Moduli of_gradients(const Mat6& c) {
  Moduli A;
  for (int i = 0; i < 3; ++i)
    for (int p = 0; p < 3; ++p)
      for (int j = 0; j < 3; ++j)
        for (int q = 0; q < 3; ++q) A(3 * i + p, 3 * j + q) = c(voigt_of[i][p], voigt_of[j][q]);
  return A;
}

struct Isochoric {
  Mat3 F, sigma;  // sigma: of the isochoric part
  Mat6 c;
  double J_minus_1 = 0;
};

Isochoric isochoric_state(const Layer& layer, const PlaneDeformation& F2, double ln_J) {
  Isochoric s;
  s.F.setZero();
  s.F(0, 0) = F2(0, 0);
  s.F(0, 2) = F2(0, 1);
  s.F(2, 0) = F2(1, 0);
  s.F(2, 2) = F2(1, 1);
  s.F(1, 1) = std::exp(ln_J) / F2.determinant();
  s.J_minus_1 = std::expm1(ln_J);
  const double J = 1 + s.J_minus_1;
  const Response r = isochoric(layer.material, right_cauchy_green(s.F), layer.fibres);
  s.sigma = cauchy(s.F, r.S, J);
  s.c = push_forward(s.F, r.D, J);
  return s;
}

// ln J with sigma_yy = 0. Bulk moduli are far larger than shear moduli, so Newton's method with
// both converges at once.
bool find_volume(const Layer& layer, const PlaneDeformation& F2, Isochoric& s, double& ln_J) {
  for (int iteration = 0; iteration < 100; ++iteration) {
    s = isochoric_state(layer, F2, ln_J);
    const Energy<double> U = volume_energy(layer.material.volume, s.J_minus_1);
    const double J = 1 + s.J_minus_1;
    const double residual = s.sigma(1, 1) + U.dW;
    const double slope = J * U.ddW + s.c(1, 1) + 2 * std::abs(s.sigma(1, 1));
    if (!std::isfinite(residual) || !(slope > 0)) return false;
    const double step = -residual / slope;
    if (std::abs(step) < 1e-15) return true;
    ln_J += std::clamp(step, -0.2, 0.2);
  }
  return false;
}

}  // namespace

LayerState layer_state(const Layer& layer, const PlaneDeformation& F2, Dilatation dilatation) {
  LayerState state;
  const PlaneDeformation F = F2 * layer.own;
  if (!F.allFinite() || !possible_stretch(F.determinant())) return state;
  double ln_J = 0;
  Isochoric s;
  const bool compressible = dilatation == Dilatation::compressible;
  if (compressible) {
    if (!find_volume(layer, F, s, ln_J)) return state;
  } else {
    s = isochoric_state(layer, F, 0);
  }
  const double J = 1 + s.J_minus_1;
  const double pressure = s.sigma(1, 1);
  state.A = of_gradients(s.c);
  for (int i = 0; i < 3; ++i) {
    for (int p = 0; p < 3; ++p) {
      for (int q = 0; q < 3; ++q) state.A(3 * i + p, 3 * i + q) += s.sigma(p, q);
      state.A(3 * i + p, 3 * p + i) += pressure;
      if (compressible) state.A(3 * i + i, 3 * p + p) -= pressure;
    }
  }
  if (compressible) {
    state.bulk = J * volume_energy(layer.material.volume, s.J_minus_1).ddW;
  }
  const Mat3 C = right_cauchy_green(s.F);
  for (const ViscousBranch& branch : branches_of(layer.material)) {
    const Response r = isochoric(layer.material, C, layer.fibres, only(branch.of));
    state.branches.push_back({branch.tau, branch.gamma * of_gradients(push_forward(s.F, r.D, J))});
  }
  state.F = s.F;
  state.sigma = s.sigma - pressure * Mat3::Identity();
  state.thickness = layer.thickness * s.F(1, 1);
  state.density = layer.density / J;
  state.exists = state.A.allFinite();
  return state;
}

std::vector<double> body_waves(const LayerState& state, const Vec3& n) {
  Mat3 Q;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      Q(i, j) = 0;
      for (int p = 0; p < 3; ++p)
        for (int q = 0; q < 3; ++q) Q(i, j) += state.A(3 * i + p, 3 * j + q) * n[p] * n[q];
    }
  if (state.bulk > 0) {
    Q += state.bulk * n * n.transpose();
    const Vec3 all = principal_values(Q);
    return {all[0], all[1], all[2]};
  }
  const Vec3 s = n.unitOrthogonal();
  const Vec3 t = n.cross(s);
  Mat2 P;
  P << s.dot(Q * s), s.dot(Q * t), t.dot(Q * s), t.dot(Q * t);
  const Vec2 both = principal_values(P);
  return {both[0], both[1]};
}

}  // namespace langer
