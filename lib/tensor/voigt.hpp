// Symmetric tensors as six components in the order [11 22 33 12 23 13].
// Stress-like vectors hold the components; strain-like vectors hold engineering shear (2 E12, ...).
// A fourth-order tensor with minor symmetries is a 6x6 matrix D with  S = D E  in these two kinds:
//   rows and columns  11 22 33 12 23 13,   D(p, q) = D_ijkl  with  p = ij, q = kl
#pragma once

#include "tensor/types.hpp"

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
inline Mat6 symmetric_product(const Mat3& A) {
  Mat6 P;
  for (int p = 0; p < 6; ++p)
    for (int q = 0; q < 6; ++q) {
      const int i = voigt_i[p], j = voigt_j[p], k = voigt_i[q], l = voigt_j[q];
      P(p, q) = 0.5 * (A(i, k) * A(j, l) + A(i, l) * A(j, k));
    }
  return P;
}

}  // namespace langer
