#include "mechanics/material/uniaxial.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include "mechanics/material/downhill_step.hpp"
#include "mechanics/material/existence.hpp"

namespace langer {

namespace {

// Energy at ln lambda = (x, y, z), y = ln J - x - z, with derivatives in (ln J, z); tau is the
// Kirchhoff stress.
//   dW/dlnJ = tau_y    dW/dz = tau_z - tau_y
struct Pulled {
  double W;
  double tau_x_minus_y;
  Vec2 g;
  Mat2 H;
  Vec2 scale;  // size of what cancels in g
};

struct Pull {
  const Material& material;
  std::vector<Vec3> a;
  double x;  // ln lambda
  bool incompressible;

  std::optional<Pulled> at(double ln_J, double z) const {
    const double y = ln_J - x - z;
    const Vec3 c = Vec3(std::exp(2 * x), std::exp(2 * y), std::exp(2 * z));
    const Response r = isochoric(material, c.asDiagonal(), a);
    const Vec3 tau = c.cwiseProduct(r.S.head<3>());
    //   dtau_i/dln lambda_j = 2 tau_i [i = j] + c_i D_ij c_j
    const Mat3 M =
        c.asDiagonal() * r.D.topLeftCorner<3, 3>() * c.asDiagonal() + Mat3((2 * tau).asDiagonal());
    Pulled s;
    s.W = r.W;
    s.tau_x_minus_y = tau[0] - tau[1];
    s.g = {tau[1], tau[2] - tau[1]};
    s.H(0, 0) = M(1, 1);
    s.H(0, 1) = s.H(1, 0) = M(1, 2) - M(1, 1);
    s.H(1, 1) = M(1, 1) - M(1, 2) - M(2, 1) + M(2, 2);
    s.scale.setConstant(tau.cwiseAbs().maxCoeff() + std::abs(s.H(1, 1)));
    if (incompressible) {
      s.g[0] = s.H(0, 1) = s.H(1, 0) = 0;
      s.H(0, 0) = 1;
    } else {
      const double J = std::exp(ln_J);
      const Energy<double> U = volume_energy(material.volume, std::expm1(ln_J));
      s.W += U.W;
      s.g[0] += J * U.dW;
      s.H(0, 0) += J * U.dW + J * J * U.ddW;
      s.scale[0] += std::abs(J * U.dW);
    }
    if (!std::isfinite(s.W) || !s.g.allFinite() || !s.H.allFinite()) return std::nullopt;
    return s;
  }
};

bool small(const Vec2& g, const Vec2& scale, double relative) {
  return (g.cwiseAbs().array() <= relative * scale.array()).all();
}

Uniaxial state(const Material& material, double lambda, bool incompressible) {
  // rounding in the energy terms leaves a few eps; a steep exponential leaves c2 x^2 times more
  constexpr double eps = std::numeric_limits<double>::epsilon(), enough = 64 * eps,
                   acceptable = 1e6 * eps;
  Uniaxial u;
  u.stretch[0] = lambda;
  if (!possible_stretch(lambda)) return u;
  const Pull pull{material, fibre_directions(material), std::log(lambda), incompressible};
  double ln_J = 0;
  double z = -0.5 * pull.x;
  std::optional<Pulled> s = pull.at(ln_J, z);
  bool downhill = true;
  for (int iteration = 0; s && downhill && iteration < 100 && !small(s->g, s->scale, enough);
       ++iteration) {
    Vec2 d = downhill_step(s->g, s->H);
    downhill = false;
    for (int halving = 0; halving < 40 && !downhill; ++halving, d /= 2) {
      const auto next = pull.at(ln_J + d[0], z + d[1]);
      // near the minimum W has no digits left to compare, there the slope decides
      downhill = next && (next->W < s->W || next->g.cwiseQuotient(s->scale).norm() <
                                                0.5 * s->g.cwiseQuotient(s->scale).norm());
      if (!downhill) continue;
      ln_J += d[0];
      z += d[1];
      s = next;
      break;
    }
  }
  if (!s) return u;
  u.converged = small(s->g, s->scale, acceptable);
  u.J_minus_1 = std::expm1(ln_J);
  u.stretch = Vec3(lambda, std::exp(ln_J - pull.x - z), std::exp(z));
  u.sigma = s->tau_x_minus_y / (1 + u.J_minus_1);
  return u;
}

}  // namespace

Uniaxial uniaxial(const Material& material, double lambda) {
  return state(material, lambda, false);
}
Uniaxial uniaxial_incompressible(const Material& material, double lambda) {
  return state(material, lambda, true);
}

std::optional<std::vector<double>> uniaxial_curve(const Material& material,
                                                  std::span<const double> strain,
                                                  StressMeasure measure, Dilatation dilatation) {
  std::vector<double> stress;
  stress.reserve(strain.size());
  for (double e : strain) {
    const Uniaxial u = state(material, 1 + e, dilatation == Dilatation::incompressible);
    if (!u.converged) return std::nullopt;
    const double nominal = u.sigma * (1 + u.J_minus_1) / (1 + e);
    if (measure == StressMeasure::cauchy)
      stress.push_back(u.sigma);
    else if (measure == StressMeasure::nominal)
      stress.push_back(nominal);
    else
      stress.push_back(nominal / (1 + e));
  }
  return stress;
}

}  // namespace langer
