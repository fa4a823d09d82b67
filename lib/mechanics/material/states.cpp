#include "mechanics/material/states.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/tensor/kinematics.hpp"
#include "core/tensor/stress.hpp"
#include "mechanics/material/downhill_step.hpp"
#include "mechanics/material/existence.hpp"
#include "mechanics/mesh/directions.hpp"

namespace langer {

namespace {

Mat3 gradient(double lambda_x, double lambda_z, double g) {
  Mat3 F = Mat3::Zero();
  F(0, 0) = lambda_x;
  F(1, 1) = 1 / (lambda_x * lambda_z);
  F(2, 2) = lambda_z;
  F(0, 2) = g;
  return F;
}

struct Sample {
  Response r;
  Vec2 slope;
  Mat2 curvature;
  double scale;  // size of what cancels in the slope
};

// Energy over q = (ln lambda_z, g), with derivatives; a q that is imposed has slope 0 and
// curvature 1.
//   W' = P:F',  P = F S;   W'' = F'S:F' + E':D:E' + P:F'',  E' = sym F^T F'
struct Sheet {
  const Material& material;
  std::span<const Vec3> a;
  double lambda_x;
  bool free_width, free_shear;
  const PointMemory* memory;

  std::optional<Sample> at(const Vec2& q) const {
    const Mat3 F = gradient(lambda_x, std::exp(q[0]), q[1]);
    Sample s;
    const Mat3 C = right_cauchy_green(F);
    if (memory) {
      s.r = incremental(material, C, a, *memory);
    } else {
      s.r = isochoric(material, C, a);
    }
    const Mat3 S = tensor(s.r.S);
    const Mat3 P = F * S;
    Mat3 dF[2] = {Mat3::Zero(), Mat3::Zero()};
    dF[0](2, 2) = F(2, 2);
    dF[0](1, 1) = -F(1, 1);
    dF[1](0, 2) = 1;
    Vec6 dE[2];
    for (int i = 0; i < 2; ++i) {
      const Mat3 FdF = F.transpose() * dF[i];
      dE[i] = voigt_strain(0.5 * (FdF + FdF.transpose()));
      s.slope[i] = P.cwiseProduct(dF[i]).sum();
    }
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        s.curvature(i, j) = (dF[i] * S).cwiseProduct(dF[j]).sum() + dE[i].dot(s.r.D * dE[j]);
    s.curvature(0, 0) += P(2, 2) * F(2, 2) + P(1, 1) * F(1, 1);
    s.scale =
        (P * F.transpose()).cwiseAbs().maxCoeff() + s.curvature.diagonal().cwiseAbs().maxCoeff();
    for (int i = 0; i < 2; ++i)
      if (!(i == 0 ? free_width : free_shear)) {
        s.slope[i] = 0;
        s.curvature.row(i).setZero();
        s.curvature.col(i).setZero();
        s.curvature(i, i) = 1;
      }
    if (!std::isfinite(s.r.W) || !s.slope.allFinite() || !s.curvature.allFinite())
      return std::nullopt;
    return s;
  }
};

bool solve(const Sheet& sheet, Vec2& q, Vec6& S, double& W) {
  // rounding in the energy terms leaves a few eps; a steep exponential leaves c2 x^2 times more
  constexpr double eps = std::numeric_limits<double>::epsilon(), enough = 64 * eps,
                   acceptable = 1e6 * eps;
  std::optional<Sample> s = sheet.at(q);
  const auto steepness = [](const Sample& one) {
    // without any stiffness, every state is a minimum
    if (!(one.scale > 0)) return 0.0;
    return one.slope.cwiseAbs().maxCoeff() / one.scale;
  };
  bool downhill = true;
  for (int iteration = 0; s && downhill && iteration < 100 && !(steepness(*s) <= enough);
       ++iteration) {
    Vec2 d = downhill_step(s->slope, s->curvature);
    downhill = false;
    for (int halving = 0; halving < 40 && !downhill; ++halving, d /= 2) {
      const auto next = sheet.at(q + d);
      // near the minimum W has no digits left to compare, there the slope decides
      downhill = next && (next->r.W < s->r.W || steepness(*next) < 0.5 * steepness(*s));
      if (downhill) {
        q += d;
        s = next;
      }
      if (downhill) break;
    }
  }
  if (!s) return false;
  S = s->r.S;
  W = s->r.W;
  return steepness(*s) <= acceptable;
}

// Whether every fibre is along x: then width and thickness of a uniaxial test are equal by
// symmetry.
bool axial(std::span<const Vec3> a) {
  return std::all_of(a.begin(), a.end(),
                     [](const Vec3& one) { return one[1] == 0 && one[2] == 0; });
}

}  // namespace

PlaneState plane_state(const Material& material, std::span<const Vec3> a, TestKind kind,
                       double first, double second, OffAxisShear shear, const PointMemory* memory) {
  const bool slides = kind == TestKind::simple_shear;
  const double lambda_x = slides ? 1 : first;
  double lambda_z = 1;
  if (kind == TestKind::biaxial) lambda_z = second;
  if (kind == TestKind::equibiaxial) lambda_z = first;
  PlaneState state;
  if (!possible_stretch(lambda_x) || !possible_stretch(lambda_z) ||
      !std::isless(std::abs(first), largest_stretch))
    return state;
  if (kind == TestKind::uniaxial) lambda_z = 1 / std::sqrt(lambda_x);
  Vec2 q(std::log(lambda_z), slides ? first : 0);
  const bool off_axis = !axial(a);
  const bool free_width = kind == TestKind::uniaxial && off_axis;
  const bool free_shear = shear == OffAxisShear::free && !slides && off_axis;
  Vec6 S;
  if (free_width) {
    if (!solve({material, a, lambda_x, true, free_shear, memory}, q, S, state.W)) return state;
    state.F = gradient(lambda_x, std::exp(q[0]), q[1]);
  } else if (free_shear) {
    if (!solve({material, a, lambda_x, false, true, memory}, q, S, state.W)) return state;
    state.F = gradient(lambda_x, lambda_z, q[1]);
  } else {
    state.F = gradient(lambda_x, lambda_z, q[1]);
    const Mat3 C = right_cauchy_green(state.F);
    const Response r =
        memory ? incremental(material, C, a, *memory, false) : isochoric(material, C, a, false);
    S = r.S;
    state.W = r.W;
  }
  state.sigma = cauchy(state.F, S, 1);
  state.sigma -= state.sigma(1, 1) * Mat3::Identity();
  state.converged = state.sigma.allFinite() && std::isfinite(state.W);
  return state;
}

std::array<double, 2> measured_stress(const PlaneState& state, TestKind kind,
                                      StressMeasure measure) {
  // F and sigma in the plane; the thickness carries nothing
  const double fx = state.F(0, 0);
  const double fz = state.F(2, 2);
  const double g = state.F(0, 2);
  const double xx = state.sigma(0, 0);
  const double zz = state.sigma(2, 2);
  const double xz = state.sigma(0, 2);
  // P = sigma F^-T,  F^-1 = [1/fx, -g/(fx fz); 0, 1/fz],  S = F^-1 P
  if (kind == TestKind::simple_shear) {
    if (measure == StressMeasure::cauchy) return {xz, 0};
    if (measure == StressMeasure::nominal) return {xz / fz, 0};
    return {(xz - g / fz * zz) / (fx * fz), 0};
  }
  if (measure == StressMeasure::cauchy) return {xx, zz};
  if (measure == StressMeasure::nominal) return {(xx - g / fz * xz) / fx, zz / fz};
  return {(xx - 2 * g / fz * xz + g * g / (fz * fz) * zz) / (fx * fx), zz / (fz * fz)};
}

std::vector<Vec3> specimen_fibres(const Material& material, double angle_deg) {
  std::vector<Vec3> a;
  for (double alpha : fibre_angles(material)) a.push_back(fibre_direction(alpha + angle_deg));
  return a;
}

}  // namespace langer
