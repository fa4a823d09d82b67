#include "core/tensor/push_forward.hpp"

#include "core/tensor/voigt.hpp"

namespace langer {

// T maps components of a symmetric reference tensor A to those of F A F^T.
Mat6 push_forward(const Mat3& F, const Mat6& D, double J) {
  Mat6 T;
  for (int p = 0; p < 6; ++p) {
    for (int q = 0; q < 6; ++q) {
      const int i = voigt_i[p];
      const int j = voigt_j[p];
      const int k = voigt_i[q];
      const int l = voigt_j[q];
      if (k == l) {
        T(p, q) = F(i, k) * F(j, k);
      } else {
        T(p, q) = F(i, k) * F(j, l) + F(i, l) * F(j, k);
      }
    }
  }
  return T * D * T.transpose() / J;
}

}  // namespace langer
