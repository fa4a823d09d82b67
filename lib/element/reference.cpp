#include "element/reference.hpp"

#include <Eigen/LU>
#include <stdexcept>

namespace langer {

namespace {

// quadratic Lagrange polynomial of the node at -1, 0 or 1, and its slope
double lagrange(double node, double x) { return node == 0 ? 1 - x * x : 0.5 * x * (x + node); }
double slope(double node, double x) { return node == 0 ? -2 * x : x + 0.5 * node; }

Vec3 point(const double* x) { return {x[0], x[1], x[2]}; }

template <class Cell>
ReferenceCell hexahedron(const double (*node)[3]) {
  ReferenceCell cell;
  cell.n_nodes = Cell::n_nodes, cell.n_gauss = Cell::n_gauss, cell.n_corners = 8;
  cell.shape = [](const Vec3& xi) -> VecX { return Cell::shape(xi); };
  cell.gradient = [](const Vec3& xi) -> Gradients { return Cell::gradient(xi); };
  for (int a = 0; a < cell.n_nodes; ++a) cell.node.push_back(point(node[a])), cell.nearest_gauss.push_back(a);
  // In hex27 the stress is best where 2 x 2 x 2 Gauss points would lie; a trilinear field fitted to all goes through there.
  MatX at_gauss(cell.n_gauss, 8), at_nodes(cell.n_nodes, 8);
  for (int g = 0; g < cell.n_gauss; ++g) {
    const Vec3 xi = Cell::gauss(g);
    cell.gauss.push_back(xi), cell.weight.push_back(Cell::weight(g));
    cell.N.push_back(cell.shape(xi)), cell.dN.push_back(cell.gradient(xi));
    at_gauss.row(g) = Hex8::shape(xi).transpose();
  }
  for (int a = 0; a < cell.n_nodes; ++a) at_nodes.row(a) = Hex8::shape(cell.node[a]).transpose();
  const MatX weighted = at_gauss.transpose() * Eigen::Map<VecX>(cell.weight.data(), cell.n_gauss).asDiagonal();
  cell.at_nodes = at_nodes * (weighted * at_gauss).inverse() * weighted;
  const auto node_at = [&](const Vec3& xi) {
    for (int a = 0; a < cell.n_nodes; ++a)
      if ((cell.node[a] - xi).norm() < 0.5) return a;
    return -1;
  };
  for (int a = 0; a < 8; ++a)
    for (int b = a + 1; b < 8; ++b)
      if ((cell.node[a] - cell.node[b]).norm() == 2) cell.edge.push_back({a, b});
  for (const auto& corners : Hex8::facet) {
    std::vector<int> nodes(corners, corners + 4);
    Vec3 middle = Vec3::Zero();
    for (int k = 0; k < 4 && cell.n_nodes > 8; ++k) {
      nodes.push_back(node_at((cell.node[corners[k]] + cell.node[corners[(k + 1) % 4]]) / 2));
      middle += cell.node[corners[k]] / 4;
    }
    if (cell.n_nodes > 8) nodes.push_back(node_at(middle));
    cell.facet.push_back(nodes);
  }
  return cell;
}

}  // namespace

Hex27::Shape Hex27::shape(const Vec3& xi) {
  Shape N;
  for (int a = 0; a < 27; ++a) N[a] = lagrange(node[a][0], xi[0]) * lagrange(node[a][1], xi[1]) * lagrange(node[a][2], xi[2]);
  return N;
}

Hex27::Gradient Hex27::gradient(const Vec3& xi) {
  Gradient dN;
  for (int a = 0; a < 27; ++a)
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      dN(a, k) = slope(node[a][k], xi[k]) * lagrange(node[a][i], xi[i]) * lagrange(node[a][j], xi[j]);
    }
  return dN;
}

const ReferenceCell& reference(int n_nodes) {
  static const ReferenceCell hex8 = hexahedron<Hex8>(Hex8::corner), hex27 = hexahedron<Hex27>(Hex27::node);
  switch (n_nodes) {
    case 8:
      return hex8;
    case 27:
      return hex27;
  }
  throw std::logic_error("no reference cell has " + std::to_string(n_nodes) + " nodes");
}

}  // namespace langer
