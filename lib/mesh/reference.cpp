#include "mesh/reference.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <initializer_list>
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
  for (int f = 0; f < 6; ++f) {  // n x n Gauss points of the facet: a layer of those of the cell, moved onto its plane
    const int axis = f / 2;
    const double side = f % 2 == 0 ? -1 : 1, layer = cell.n_nodes == 8 ? 1 : 5. / 9;
    std::vector<FacetPoint>& points = cell.facet_points.emplace_back();
    for (int g = 0; g < cell.n_gauss; ++g) {
      Vec3 xi = cell.gauss[g];
      if (xi[axis] * side < 0.5) continue;
      xi[axis] = side;
      points.push_back({xi, cell.weight[g] / layer, Vec3::Unit((axis + 1) % 3), Vec3::Unit((axis + 2) % 3)});
    }
  }
  return cell;
}

// 1 - xi - eta - zeta, xi, eta, zeta and what is made of them
struct Barycentric {
  double L[4];
  explicit Barycentric(const Vec3& xi) : L{1 - xi.sum(), xi[0], xi[1], xi[2]} {}
  static Vec3 slope(int i) { return i == 0 ? Vec3(-1, -1, -1) : Vec3(Vec3::Unit(i - 1)); }
  Vec3 slope_of_product(std::initializer_list<int> of) const {
    Vec3 sum = Vec3::Zero();
    for (int i : of) {
      double others = 1;
      for (int j : of) others *= j == i ? 1 : L[j];
      sum += others * slope(i);
    }
    return sum;
  }
};

bool on_edge(const int* facet, const int* edge) {
  int n = 0;
  for (int k = 0; k < 3; ++k) n += facet[k] == edge[0] || facet[k] == edge[1];
  return n == 2;
}

// Row by row: corners and edges as the quadratic tetrahedron has them, bubbles 27 L L L of the facets and 256 L L L L of the cell;
// then each less its values at the later nodes, so that it is 1 at its own node and 0 at all others.
template <class Values>
void to_nodes(Values& N) {
  for (int f = 0; f < 4; ++f) N.row(10 + f) -= 27. / 64 * N.row(14);
  for (int e = 0; e < 6; ++e) {
    for (int f = 0; f < 4; ++f)
      if (on_edge(Tet15::facet[f], Tet15::edge[e])) N.row(4 + e) -= 4. / 9 * N.row(10 + f);
    N.row(4 + e) -= 1. / 4 * N.row(14);
  }
  for (int i = 0; i < 4; ++i) {
    for (int f = 0; f < 4; ++f)
      for (int corner : Tet15::facet[f])
        if (corner == i) N.row(i) += 1. / 9 * N.row(10 + f);
    N.row(i) += 1. / 8 * N.row(14);
  }
}

// 14 points of degree 5 with positive weights (N. J. Walkington, Quadrature on simplices of arbitrary dimension, 2000);
// on facets the 7 points of degree 5 (J. Radon, 1948)
ReferenceCell tetrahedron() {
  ReferenceCell cell;
  cell.n_nodes = Tet15::n_nodes, cell.n_gauss = Tet15::n_gauss, cell.n_corners = 4;
  cell.shape = [](const Vec3& xi) -> VecX { return Tet15::shape(xi); };
  cell.gradient = [](const Vec3& xi) -> Gradients { return Tet15::gradient(xi); };
  const Vec3 corner[4] = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  for (const Vec3& x : corner) cell.node.push_back(x);
  for (const auto& [a, b] : Tet15::edge) cell.node.push_back((corner[a] + corner[b]) / 2), cell.edge.push_back({a, b});
  for (const auto& [a, b, c] : Tet15::facet) cell.node.push_back((corner[a] + corner[b] + corner[c]) / 3);
  cell.node.push_back(Vec3::Constant(0.25));

  const auto add = [&](const Vec3& xi, double weight) { cell.gauss.push_back(xi), cell.weight.push_back(weight / 6); };
  for (const auto& [a, weight] :
       {std::pair{0.31088591926330060980, 0.11268792571801585080}, {0.092735250310891226402, 0.073493043116361949544}})
    for (const Vec3& x : corner) add(Vec3::Constant(a) + (1 - 4 * a) * x, weight);
  constexpr double a = 0.045503704125649649492;
  for (const auto& [i, j] : Tet15::edge) add(Vec3::Constant(a) + (0.5 - 2 * a) * (corner[i] + corner[j]), 0.042546020777081466438);

  MatX at_gauss(cell.n_gauss, 4), at_nodes(cell.n_nodes, 4);
  for (int g = 0; g < cell.n_gauss; ++g) {
    cell.N.push_back(cell.shape(cell.gauss[g])), cell.dN.push_back(cell.gradient(cell.gauss[g]));
    at_gauss.row(g) << 1, cell.gauss[g].transpose();
  }
  for (int n = 0; n < cell.n_nodes; ++n) {
    at_nodes.row(n) << 1, cell.node[n].transpose();
    const auto distance = [&](int g) { return (cell.gauss[g] - cell.node[n]).norm(); };
    int nearest = 0;
    for (int g = 1; g < cell.n_gauss; ++g)
      if (distance(g) < distance(nearest) - 1e-12) nearest = g;
    cell.nearest_gauss.push_back(nearest);
  }
  const MatX weighted = at_gauss.transpose() * Eigen::Map<VecX>(cell.weight.data(), cell.n_gauss).asDiagonal();
  cell.at_nodes = at_nodes * (weighted * at_gauss).inverse() * weighted;

  for (int f = 0; f < 4; ++f) {
    const auto& corners = Tet15::facet[f];
    std::vector<int> nodes(corners, corners + 3);
    for (int k = 0; k < 3; ++k) {
      const int one[2] = {corners[k], corners[(k + 1) % 3]};
      for (int e = 0; e < 6; ++e)
        if (std::min(one[0], one[1]) == Tet15::edge[e][0] && std::max(one[0], one[1]) == Tet15::edge[e][1]) nodes.push_back(4 + e);
    }
    nodes.push_back(10 + f);
    cell.facet.push_back(nodes);

    const Vec3 X[3] = {corner[corners[0]], corner[corners[1]], corner[corners[2]]}, middle = cell.node[10 + f];
    std::vector<FacetPoint>& points = cell.facet_points.emplace_back();
    points.push_back({middle, 9. / 80, X[1] - X[0], X[2] - X[0]});
    for (double sign : {-1., 1.}) {
      const double b = (6 + sign * std::sqrt(15.)) / 21, weight = (155 + sign * std::sqrt(15.)) / 2400;
      for (const Vec3& x : X) points.push_back({3 * b * middle + (1 - 3 * b) * x, weight, X[1] - X[0], X[2] - X[0]});
    }
  }
  return cell;
}

}  // namespace

Tet15::Shape Tet15::shape(const Vec3& xi) {
  const Barycentric b(xi);
  const double* L = b.L;
  Shape N;
  for (int i = 0; i < 4; ++i) N[i] = L[i] * (2 * L[i] - 1);
  for (int e = 0; e < 6; ++e) N[4 + e] = 4 * L[edge[e][0]] * L[edge[e][1]];
  for (int f = 0; f < 4; ++f) N[10 + f] = 27 * L[facet[f][0]] * L[facet[f][1]] * L[facet[f][2]];
  N[14] = 256 * L[0] * L[1] * L[2] * L[3];
  to_nodes(N);
  return N;
}

Tet15::Gradient Tet15::gradient(const Vec3& xi) {
  const Barycentric b(xi);
  Gradient dN;
  for (int i = 0; i < 4; ++i) dN.row(i) = (4 * b.L[i] - 1) * Barycentric::slope(i).transpose();
  for (int e = 0; e < 6; ++e) dN.row(4 + e) = 4 * b.slope_of_product({edge[e][0], edge[e][1]}).transpose();
  for (int f = 0; f < 4; ++f) dN.row(10 + f) = 27 * b.slope_of_product({facet[f][0], facet[f][1], facet[f][2]}).transpose();
  dN.row(14) = 256 * b.slope_of_product({0, 1, 2, 3}).transpose();
  to_nodes(dN);
  return dN;
}

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
  static const ReferenceCell hex8 = hexahedron<Hex8>(Hex8::corner), hex27 = hexahedron<Hex27>(Hex27::node), tet15 = tetrahedron();
  switch (n_nodes) {
    case 8:
      return hex8;
    case 15:
      return tet15;
    case 27:
      return hex27;
  }
  throw std::logic_error("no reference cell has " + std::to_string(n_nodes) + " nodes");
}

}  // namespace langer
