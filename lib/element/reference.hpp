// The 8-node hexahedron on [-1, 1]^3: nodes in VTK order, shape functions, Gauss points.
//   N_a = (1 + xi xi_a)(1 + eta eta_a)(1 + zeta zeta_a) / 8
// Gauss point g lies in the corner of node g; all weights are 1.
#pragma once

#include <array>
#include <cmath>

#include "tensor/types.hpp"

namespace langer {

struct Hex8 {
  static constexpr int n_nodes = 8;
  static constexpr int n_gauss = 8;
  static constexpr int n_dofs = 24;
  // xi_a, eta_a, zeta_a
  static constexpr double corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                          {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  // nodes of local facet f, counter-clockwise seen from outside; 0 -xi, 1 +xi, 2 -eta, 3 +eta, 4 -zeta, 5 +zeta
  static constexpr int facet[6][4] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};

  using Shape = Eigen::Matrix<double, 8, 1>;
  using Gradient = Eigen::Matrix<double, 8, 3>;

  static Shape shape(const Vec3& xi) {
    Shape N;
    for (int a = 0; a < 8; ++a)
      N[a] = 0.125 * (1 + corner[a][0] * xi[0]) * (1 + corner[a][1] * xi[1]) * (1 + corner[a][2] * xi[2]);
    return N;
  }

  // dN_a/dxi_k
  static Gradient gradient(const Vec3& xi) {
    Gradient dN;
    for (int a = 0; a < 8; ++a) {
      const double f[3] = {1 + corner[a][0] * xi[0], 1 + corner[a][1] * xi[1], 1 + corner[a][2] * xi[2]};
      dN(a, 0) = 0.125 * corner[a][0] * f[1] * f[2];
      dN(a, 1) = 0.125 * corner[a][1] * f[0] * f[2];
      dN(a, 2) = 0.125 * corner[a][2] * f[0] * f[1];
    }
    return dN;
  }

  static Vec3 gauss(int g) { return Vec3(corner[g][0], corner[g][1], corner[g][2]) / std::sqrt(3.0); }
};

}  // namespace langer
