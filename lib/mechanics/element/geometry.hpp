// What the integrals over one element's reference volume need.
//   dN_dX[g]  (nodes,3) gradients of the shape functions with respect to X at Gauss point g [1/mm]
//   w[g]      weight times Jacobian [mm^3];  V their sum
//   mode[g]   cells of second order: 1 and three linear functions of X, orthonormal in the mean
//             over the element:
//             integral mode_i mode_j dV0 = V delta_ij. They span {1, X, Y, Z} whatever the cell's shape and direction.
#pragma once

#include <array>
#include <vector>

#include "mechanics/mesh/mesh.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

inline constexpr int n_modes = 4;

struct ElementGeometry {
  std::vector<Gradients> dN_dX;
  std::vector<double> w;
  std::vector<std::array<double, n_modes>> mode;
  double V = 0;

  int n_nodes() const { return static_cast<int>(dN_dX[0].rows()); }
  int n_gauss() const { return static_cast<int>(w.size()); }
};

using ElementNodes =
    Eigen::Matrix<double, Eigen::Dynamic, 3, 0, most_nodes, 3>;  // one row per node

ElementNodes element_nodes(const Mesh& mesh, int e);  // reference positions
ElementNodes element_values(const Mesh& mesh, int e,
                            const VecX& u);  // of a field with three components per node
ElementGeometry element_geometry(const ElementNodes& X);

// du/dX (3,3)
Mat3 displacement_gradient(const ElementNodes& u, const Gradients& dN_dX);

}  // namespace langer
