// Strain operator, dilatation gradient and geometric stiffness of one Gauss point, for elements
// whose number of nodes the compiler knows (solid.cpp, conserving_solid.cpp).
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "core/tensor/kinematics.hpp"
#include "core/tensor/voigt.hpp"
#include "mechanics/element/geometry.hpp"

namespace langer {

template <int n>
struct Sizes {
  using Gradient = Eigen::Matrix<double, n, 3>;
  using Vec = Eigen::Matrix<double, 3 * n, 1>;
  using Mat = Eigen::Matrix<double, 3 * n, 3 * n>;
  using Strain = Eigen::Matrix<double, 6, 3 * n>;
};

// dE = B du, engineering shear: row p = ij of node a, direction k is F_ki dN_j + F_kj dN_i
template <int n>
typename Sizes<n>::Strain strain_operator(const Mat3& F, const typename Sizes<n>::Gradient& dN) {
  typename Sizes<n>::Strain B;
  for (int a = 0; a < n; ++a)
    for (int k = 0; k < 3; ++k)
      for (int p = 0; p < 6; ++p) {
        const int i = voigt_i[p];
        const int j = voigt_j[p];
        if (p < 3) {
          B(p, 3 * a + k) = F(k, i) * dN(a, i);
        } else {
          B(p, 3 * a + k) = F(k, i) * dN(a, j) + F(k, j) * dN(a, i);
        }
      }
  return B;
}

// dJ/du of one point: cofactor of F contracted with grad(du)
template <int n>
typename Sizes<n>::Vec dilatation_gradient(const Mat3& F, const typename Sizes<n>::Gradient& dN) {
  Mat3 cof;
  cof.col(0) = F.col(1).cross(F.col(2));
  cof.col(1) = F.col(2).cross(F.col(0));
  cof.col(2) = F.col(0).cross(F.col(1));
  const typename Sizes<n>::Gradient g = dN * cof.transpose();
  typename Sizes<n>::Vec v;
  for (int a = 0; a < n; ++a)
    for (int i = 0; i < 3; ++i) v[3 * a + i] = g(a, i);
  return v;
}

template <int n, class Mat>
void add_geometric(const typename Sizes<n>::Gradient& dN, const Vec6& S, double w, Mat& K) {
  const Eigen::Matrix<double, n, n> G = w * (dN * tensor(S) * dN.transpose());
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      for (int i = 0; i < 3; ++i) K(3 * a + i, 3 * b + i) += G(a, b);
}

// Dilatation mode k of a cell at Gauss point g.
inline double dilatation_mode(const ElementGeometry& geometry, int g, int k) {
  if (k == 0) return 1;
  return geometry.mode[g][k];
}

// The Gauss points of a displaced cell of n nodes.
template <int n>
struct GaussPoints {
  std::vector<Mat3> F;
  std::vector<double> J_minus_1;
  std::vector<typename Sizes<n>::Vec> dJ;
  std::vector<typename Sizes<n>::Gradient> dN;
  double J_min = 1e300;

  GaussPoints(const ElementGeometry& geometry, const ElementNodes& u) {
    for (int g = 0; g < geometry.n_gauss(); ++g) {
      const Mat3 H = displacement_gradient(u, geometry.dN_dX[g]);
      F.push_back(Mat3::Identity() + H);
      J_minus_1.push_back(volume_change(H));
      J_min = std::min(J_min, 1 + J_minus_1[g]);
      dN.push_back(geometry.dN_dX[g]);
      dJ.push_back(dilatation_gradient<n>(F[g], dN[g]));
    }
  }
};

}  // namespace langer
