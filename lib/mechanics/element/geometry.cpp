#include "mechanics/element/geometry.hpp"

#include <Eigen/LU>

namespace langer {

namespace {

// The modes {1, X, Y, Z} of a cell, made orthonormal by Gram-Schmidt (twice, for the last digits).
// It starts from the linear functions of X that are close to xi, eta and zeta: in these coordinates
// a long and thin cell is as well conditioned as any other.
void add_modes(const ReferenceCell& cell, const ElementNodes& X, ElementGeometry& geometry) {
  Vec3 middle = Vec3::Zero();
  Mat3 mean = Mat3::Zero();  // dX/dxi
  for (int g = 0; g < cell.n_gauss; ++g) {
    const double share = geometry.w[g] / geometry.V;
    middle += share * (X.transpose() * cell.N[g]);
    mean += share * (X.transpose() * cell.dN[g]);
  }
  const Mat3 to_xi = mean.inverse();
  geometry.mode.resize(cell.n_gauss);
  for (int g = 0; g < cell.n_gauss; ++g) {
    const Vec3 x = to_xi * (X.transpose() * cell.N[g] - middle);
    geometry.mode[g] = {1, x[0], x[1], x[2]};
  }
  const auto product = [&](int i, int j) {
    double sum = 0;
    for (int g = 0; g < cell.n_gauss; ++g)
      sum += geometry.w[g] * geometry.mode[g][i] * geometry.mode[g][j];
    return sum / geometry.V;
  };
  for (int round = 0; round < 2; ++round)
    for (int i = 1; i < n_modes; ++i) {
      for (int j = 0; j < i; ++j) {
        const double part = product(i, j);
        for (auto& m : geometry.mode) m[i] -= part * m[j];
      }
      const double length = std::sqrt(product(i, i));
      for (auto& m : geometry.mode) m[i] /= length;
    }
}

}  // namespace

ElementNodes element_nodes(const Mesh& mesh, int e) {
  const auto nodes = mesh.cell(e);
  ElementNodes X(nodes.size(), 3);
  for (std::size_t a = 0; a < nodes.size(); ++a) X.row(a) = mesh.X[nodes[a]].transpose();
  return X;
}

ElementNodes element_values(const Mesh& mesh, int e, const VecX& u) {
  const auto nodes = mesh.cell(e);
  ElementNodes q(nodes.size(), 3);
  for (std::size_t a = 0; a < nodes.size(); ++a) q.row(a) = u.segment<3>(3 * nodes[a]).transpose();
  return q;
}

ElementGeometry element_geometry(const ElementNodes& X) {
  const ReferenceCell& cell = reference(static_cast<int>(X.rows()));
  ElementGeometry geometry;
  for (int g = 0; g < cell.n_gauss; ++g) {
    const Mat3 dX_dxi = X.transpose() * cell.dN[g];
    geometry.dN_dX.push_back(cell.dN[g] * dX_dxi.inverse());
    geometry.w.push_back(cell.weight[g] * dX_dxi.determinant());
    geometry.V += geometry.w[g];
  }
  if (cell.second_order()) add_modes(cell, X, geometry);
  return geometry;
}

// Flattened, so that Eigen's product is no call: this runs at every Gauss point.
[[gnu::flatten]] Mat3 displacement_gradient(const ElementNodes& u, const Gradients& dN_dX) {
  return u.transpose().lazyProduct(dN_dX);
}

}  // namespace langer
