// Stress measures of the deformed body.                                                [A23] eq. 21
//   S      second Piola-Kirchhoff stress, components [MPa]
//   sigma  Cauchy stress (3,3) [MPa]
#pragma once

#include <cmath>

#include "core/tensor/principal.hpp"
#include "core/tensor/voigt.hpp"

namespace langer {

// sigma = F S F^T / J
inline Mat3 cauchy(const Mat3& F, const Vec6& S, double J) {
  return F * tensor(S) * F.transpose() / J;
}
inline Mat3 cauchy(const Mat3& F, const Vec6& S) { return cauchy(F, S, F.determinant()); }

inline double mean_stress(const Mat3& sigma) { return sigma.trace() / 3; }

// sqrt(3/2 s:s), s the deviator
inline double von_mises(const Mat3& sigma) {
  const Mat3 s = sigma - mean_stress(sigma) * Mat3::Identity();
  return std::sqrt(1.5) * s.norm();
}

// greatest first [MPa]
inline Vec3 principal_stresses(const Mat3& sigma) { return principal_values(sigma).reverse(); }

}  // namespace langer
