// Symmetric tensors as six components in the order [11 22 33 12 23 13].
// Stress-like vectors hold the components; strain-like vectors hold engineering shear (2 E12, ...).
// A fourth-order tensor with minor symmetries is a 6x6 matrix D with  S = D E  in these two kinds:
//   rows and columns  11 22 33 12 23 13,   D(p, q) = D_ijkl  with  p = ij, q = kl
#pragma once

#include "core/tensor/types.hpp"

namespace langer {

inline constexpr int voigt_i[6] = {0, 1, 2, 0, 1, 0};
inline constexpr int voigt_j[6] = {0, 1, 2, 1, 2, 2};

// components of a symmetric tensor, shear not doubled
inline Vec6 voigt(const Mat3& A) {
  Vec6 v;
  for (int p = 0; p < 6; ++p) v[p] = A(voigt_i[p], voigt_j[p]);
  return v;
}

inline Mat3 tensor(const Vec6& v) {
  Mat3 A;
  for (int p = 0; p < 6; ++p) A(voigt_i[p], voigt_j[p]) = A(voigt_j[p], voigt_i[p]) = v[p];
  return A;
}

// engineering components of a symmetric strain
inline Vec6 voigt_strain(const Mat3& E) {
  Vec6 v = voigt(E);
  v.tail<3>() *= 2;
  return v;
}

// (A o A)_ijkl = (A_ik A_jl + A_il A_jk) / 2, the tensor with  -A o A = dA^-1/dA  for A = C^-1
// A symmetric. Written out: this stands in the innermost loop of every tangent.
inline Mat6 symmetric_product(const Mat3& A) {
  const double a = A(0, 0);
  const double b = A(1, 1);
  const double c = A(2, 2);
  const double d = A(0, 1);
  const double e = A(1, 2);
  const double f = A(0, 2);
  const double ad = a * d;
  const double af = a * f;
  const double bd = b * d;
  const double be = b * e;
  const double ce = c * e;
  const double cf = c * f;
  const double de = d * e;
  const double df = d * f;
  const double ef = e * f;
  const double p33 = 0.5 * (a * b + d * d);
  const double p44 = 0.5 * (b * c + e * e);
  const double p55 = 0.5 * (a * c + f * f);
  const double p34 = 0.5 * (de + b * f);
  const double p35 = 0.5 * (df + a * e);
  const double p45 = 0.5 * (ef + c * d);
  Mat6 P;
  P << a * a, d * d, f * f, ad, df, af,  //
      d * d, b * b, e * e, bd, be, de,   //
      f * f, e * e, c * c, ef, ce, cf,   //
      ad, bd, ef, p33, p34, p35,         //
      df, be, ce, p34, p44, p45,         //
      af, de, cf, p35, p45, p55;
  return P;
}

}  // namespace langer
