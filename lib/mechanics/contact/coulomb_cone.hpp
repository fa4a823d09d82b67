// Projection of a trial reaction on Coulomb's cone K_mu: |r_t| <= mu r_n.   [A23] eq. 27, [dSF98]
//   tau  trial reaction in the contact frame (n, t1, t2) [N];   mu >= 0 friction coefficient
//   open   mu |tau_t| <= -tau_n          r = 0
//   stick  |tau_t| <= mu tau_n           r = tau
//   slip   otherwise                     r = tau - (|tau_t| - mu tau_n)/(1 + mu^2) (t - mu n),
//                                        t = tau_t / |tau_t|
// mu = 0 gives the frictionless half-line; tau on the boundary counts as stick.
// [A23] prints the slip case with +mu n; that result leaves the cone. The projection needs -mu n.
#pragma once

#include <cmath>

#include "core/tensor/types.hpp"

namespace langer {

enum class ContactStatus { open = 0, stick = 1, slip = 2 };

struct ConeProjection {
  Vec3 r;
  ContactStatus status;
};

inline ConeProjection project_on_cone(const Vec3& tau, double mu) {
  const double tau_t = std::hypot(tau[1], tau[2]);
  if (mu * tau_t <= -tau[0]) return {Vec3::Zero(), ContactStatus::open};
  if (tau_t <= mu * tau[0]) return {tau, ContactStatus::stick};
  // r = tau - s (t - mu n),  s = (|tau_t| - mu tau_n) / (1 + mu^2),  t = tau_t / |tau_t|
  const double s = (tau_t - mu * tau[0]) / (1 + mu * mu);
  const double r_t =
      mu * (tau[0] + mu * s);  // = |tau_t| - s, written so that r lies on the cone to rounding
  return {Vec3(tau[0] + mu * s, r_t * tau[1] / tau_t, r_t * tau[2] / tau_t), ContactStatus::slip};
}

}  // namespace langer
