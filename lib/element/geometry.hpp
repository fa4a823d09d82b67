// What the integrals over one element's reference volume need.
//   dN_dX[g]  (8,3) gradients of the shape functions with respect to X at Gauss point g [1/mm]
//   w[g]      weight times Jacobian [mm^3];  V their sum
#pragma once

#include <array>

#include "element/reference.hpp"
#include "mesh/mesh.hpp"

namespace langer {

struct ElementGeometry {
  std::array<Hex8::Gradient, Hex8::n_gauss> dN_dX;
  std::array<double, Hex8::n_gauss> w;
  double V = 0;
};

using ElementNodes = Eigen::Matrix<double, 8, 3>;  // one row per node

ElementNodes element_nodes(const Mesh& mesh, int e);  // reference positions
ElementGeometry element_geometry(const ElementNodes& X);

}  // namespace langer
