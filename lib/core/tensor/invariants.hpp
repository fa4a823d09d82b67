// Invariants of C, each with gradient and Hessian with respect to C.                  [A23] eqs
// 6-11
//   I1_bar = I3^(-1/3) I:C    I4_bar = I3^(-1/3) M:C, M = a a^T    I2_bar = I3^(-2/3) I2    J = sqrt(I3)
// I1_bar and I4_bar are one invariant with two tensors M, and it is linear in M: sums of such terms
// share one Hessian.
//   gradients  (6) tensor components, shear not doubled;  Hessians  (6,6) components ijkl
//   so that  S = 2 sum W' dI_dC  and  D = 4 sum (W'' dI_dC dI_dC^T + W' d2I_dC2)  are in the order of voigt.hpp
// C must be positive definite (det F > 0 is the element's to check).
#pragma once

#include <cmath>

#include "core/tensor/voigt.hpp"

namespace langer {

// What all invariants of one C share.
struct Invariants {
  Vec6 C, C_inverse;  // components
  double I1, I3;
  double m;  // I3^(-1/3)
};

inline Invariants invariants(const Mat3& C) {
  Invariants v;
  v.C = voigt(C);
  const auto& c = v.C;  // 11 22 33 12 23 13
  Vec6 cof;
  cof << c[1] * c[2] - c[4] * c[4], c[0] * c[2] - c[5] * c[5], c[0] * c[1] - c[3] * c[3],
      c[4] * c[5] - c[3] * c[2], c[3] * c[5] - c[0] * c[4], c[3] * c[4] - c[1] * c[5];
  v.I1 = c[0] + c[1] + c[2];
  v.I3 = c[0] * cof[0] + c[3] * cof[3] + c[5] * cof[5];
  v.C_inverse = cof / v.I3;
  v.m = 1 / std::cbrt(v.I3);
  return v;
}

// A:B of symmetric tensors in components
inline double contraction(const Vec6& A, const Vec6& B) {
  return A[0] * B[0] + A[1] * B[1] + A[2] * B[2] + 2 * (A[3] * B[3] + A[4] * B[4] + A[5] * B[5]);
}

inline Vec6 identity6() { return (Vec6() << 1, 1, 1, 0, 0, 0).finished(); }

// a a^T
inline Vec6 structural_tensor(const Vec3& a) {
  return (Vec6() << a[0] * a[0], a[1] * a[1], a[2] * a[2], a[0] * a[1], a[1] * a[2], a[0] * a[2])
      .finished();
}

// C^-1 o C^-1 = -dC^-1/dC
inline Mat6 inverse_product(const Invariants& v) { return symmetric_product(tensor(v.C_inverse)); }

// --- I_bar = I3^(-1/3) M:C, which is I1_bar for M = I and I4_bar for M = a a^T

inline double linear_bar(const Invariants& v, const Vec6& M) { return v.m * contraction(M, v.C); }

//   m (M - (M:C)/3 C^-1)
inline Vec6 dlinear_bar_dC(const Invariants& v, const Vec6& M) {
  return v.m * (M - (contraction(M, v.C) / 3) * v.C_inverse);
}

//   m (-1/3 (M x C^-1 + C^-1 x M) + (M:C)/9 C^-1 x C^-1 + (M:C)/3 C^-1 o C^-1)
// = m (-1/3 (N x C^-1 + C^-1 x N) + (M:C)/3 C^-1 o C^-1),  N = M - (M:C)/6 C^-1
inline Mat6 d2linear_bar_dC2(const Invariants& v, const Vec6& M, const Mat6& C_inverse_product) {
  const double MC = contraction(M, v.C);
  const Vec6 N = M - (MC / 6) * v.C_inverse;
  const Mat6 NC = (v.m / -3) * (N * v.C_inverse.transpose());
  return NC + NC.transpose() + (v.m * MC / 3) * C_inverse_product;
}

// --- I2_bar = I3^(-2/3) I2,  I2 = (I1^2 - C:C)/2,  G = dI2/dC = I1 I - C

inline double I2_bar(const Invariants& v) {
  return 0.5 * v.m * v.m * (v.I1 * v.I1 - contraction(v.C, v.C));
}

//   m^2 (G - 2/3 I2 C^-1)
inline Vec6 dI2_bar_dC(const Invariants& v) {
  const double I2 = 0.5 * (v.I1 * v.I1 - contraction(v.C, v.C));
  return v.m * v.m * (v.I1 * identity6() - v.C - (2 * I2 / 3) * v.C_inverse);
}

//   m^2 (I x I - I o I - 2/3 (G x C^-1 + C^-1 x G) + 4/9 I2 C^-1 x C^-1 + 2/3 I2 C^-1 o C^-1)
inline Mat6 d2I2_bar_dC2(const Invariants& v, const Mat6& C_inverse_product) {
  const double I2 = 0.5 * (v.I1 * v.I1 - contraction(v.C, v.C));
  const Vec6 N = v.I1 * identity6() - v.C - (I2 / 3) * v.C_inverse;
  const Mat6 NC = (2. / -3) * (N * v.C_inverse.transpose());
  Mat6 A = NC + NC.transpose() + (2 * I2 / 3) * C_inverse_product;
  A.topLeftCorner<3, 3>().array() += 1;
  A.diagonal() -= (Vec6() << 1, 1, 1, 0.5, 0.5, 0.5).finished();
  return v.m * v.m * A;
}

// --- J = sqrt(I3)

//   J/2 C^-1
inline Vec6 dJ_dC(const Invariants& v, double J) { return (J / 2) * v.C_inverse; }

//   J/4 (C^-1 x C^-1 - 2 C^-1 o C^-1)
inline Mat6 d2J_dC2(const Invariants& v, double J, const Mat6& C_inverse_product) {
  return (J / 4) * (v.C_inverse * v.C_inverse.transpose() - 2 * C_inverse_product);
}

}  // namespace langer
