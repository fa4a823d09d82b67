#include "element/geometry.hpp"

#include <Eigen/LU>

namespace langer {

ElementNodes element_nodes(const Mesh& mesh, int e) {
  ElementNodes X;
  const auto nodes = mesh.cell(e);
  for (int a = 0; a < 8; ++a) X.row(a) = mesh.X[nodes[a]].transpose();
  return X;
}

ElementGeometry element_geometry(const ElementNodes& X) {
  ElementGeometry geometry;
  for (int g = 0; g < Hex8::n_gauss; ++g) {
    const Hex8::Gradient dN = Hex8::gradient(Hex8::gauss(g));
    const Mat3 dX_dxi = X.transpose() * dN;
    geometry.dN_dX[g] = dN * dX_dxi.inverse();
    geometry.w[g] = dX_dxi.determinant();
    geometry.V += geometry.w[g];
  }
  return geometry;
}

}  // namespace langer
