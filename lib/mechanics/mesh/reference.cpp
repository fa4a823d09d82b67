#include "mechanics/mesh/reference.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <initializer_list>
#include <numeric>

namespace langer {

namespace {

// quadratic Lagrange polynomial of the node at -1, 0 or 1, and its slope
double lagrange(double node, double x) {
  if (node == 0) return 1 - x * x;
  return 0.5 * x * (x + node);
}
double slope(double node, double x) {
  if (node == 0) return -2 * x;
  return x + 0.5 * node;
}

Vec3 point(const double* x) { return {x[0], x[1], x[2]}; }

template <class Cell>
ReferenceCell empty_row(const CellNames& names) {
  ReferenceCell cell;
  cell.type = Cell::type;
  cell.names = names;
  cell.n_nodes = Cell::n_nodes;
  cell.n_gauss = Cell::n_gauss;
  cell.shape = [](const Vec3& xi) -> VecX {
    return Cell::shape(xi);
  };
  cell.gradient = [](const Vec3& xi) -> Gradients {
    return Cell::gradient(xi);
  };
  return cell;
}

// What follows from nodes and Gauss points; linear: a basis of the fields that stress is taken for.
// In hex27 the stress is best where 2 x 2 x 2 Gauss points would lie; a trilinear field fitted to
// all goes through there.
void add_values(ReferenceCell& cell, VecX (*linear)(const Vec3& xi)) {
  MatX at_gauss(cell.n_gauss, cell.n_corners), at_nodes(cell.n_nodes, cell.n_corners);
  for (int g = 0; g < cell.n_gauss; ++g) {
    const Vec3& xi = cell.gauss[g];
    cell.N.push_back(cell.shape(xi));
    cell.dN.push_back(cell.gradient(xi));
    at_gauss.row(g) = linear(xi).transpose();
  }
  for (int a = 0; a < cell.n_nodes; ++a) at_nodes.row(a) = linear(cell.node[a]).transpose();
  const MatX weighted =
      at_gauss.transpose() * Eigen::Map<VecX>(cell.weight.data(), cell.n_gauss).asDiagonal();
  cell.at_nodes = at_nodes * (weighted * at_gauss).inverse() * weighted;
}

int node_at(const ReferenceCell& cell, const Vec3& xi) {
  for (int a = 0; a < cell.n_nodes; ++a)
    if ((cell.node[a] - xi).norm() < 1e-9) return a;
  return -1;
}

template <class Cell>
ReferenceCell hexahedron(const double (*node)[3], double end_weight, const CellNames& names) {
  ReferenceCell cell = empty_row<Cell>(names);
  cell.n_corners = 8;
  cell.facet_corners = 4;
  cell.corner_shape = [](const Vec3& xi) -> VecX {
    return Hex8::shape(xi);
  };
  for (int a = 0; a < cell.n_nodes; ++a) {
    cell.node.push_back(point(node[a]));
    cell.nearest_gauss.push_back(a);
  }
  for (int g = 0; g < cell.n_gauss; ++g) {
    cell.gauss.push_back(Cell::gauss(g));
    cell.weight.push_back(Cell::weight(g));
  }
  add_values(cell, cell.corner_shape);
  const bool second_order = cell.second_order();
  cell.layers = second_order ? 3 : 2;
  for (int a = 0; a < 8; ++a)
    for (int b = a + 1; b < 8; ++b)
      if ((cell.node[a] - cell.node[b]).norm() == 2) cell.edge.push_back({a, b});
  for (const auto& corners : Hex8::facet) {
    std::vector<int> nodes(corners, corners + 4);
    Vec3 middle = Vec3::Zero();
    for (int k = 0; k < 4 && second_order; ++k) {
      nodes.push_back(node_at(cell, (cell.node[corners[k]] + cell.node[corners[(k + 1) % 4]]) / 2));
      middle += cell.node[corners[k]] / 4;
    }
    if (second_order) nodes.push_back(node_at(cell, middle));
    cell.facet.push_back(nodes);
  }
  for (int f = 0; f < 6; ++f) {  // n x n Gauss points of the facet: a layer of those of the cell,
                                 // moved onto its plane
    const int axis = f / 2;
    const double side = f % 2 == 0 ? -1 : 1;
    std::vector<FacetPoint>& points = cell.facet_points.emplace_back();
    for (int g = 0; g < cell.n_gauss; ++g) {
      Vec3 xi = cell.gauss[g];
      if (xi[axis] * side < 0.5) continue;
      xi[axis] = side;
      points.push_back({xi, cell.weight[g] / end_weight, Vec3::Unit((axis + 1) % 3),
                        Vec3::Unit((axis + 2) % 3)});
    }
  }
  for (int octant = 0; octant < 8; ++octant)
    for (int corner = 0; corner < 8; ++corner)
      if (second_order)
        cell.parts.push_back(node_at(cell, (cell.node[octant] + cell.node[corner]) / 2));
      else if (octant == 0)
        cell.parts.push_back(corner);
  return cell;
}

// 1 - xi - eta - zeta, xi, eta, zeta and what is made of them
struct Barycentric {
  double L[4];
  explicit Barycentric(const Vec3& xi) : L{1 - xi.sum(), xi[0], xi[1], xi[2]} {}
  static Vec3 slope(int i) {
    if (i == 0) return Vec3(-1, -1, -1);
    return Vec3(Vec3::Unit(i - 1));
  }
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

// Whether an edge is one of the facet: both of its corners are.
bool on_edge(const int* facet, const int* edge) {
  int n = 0;
  for (int k = 0; k < 3; ++k) n += facet[k] == edge[0] || facet[k] == edge[1];
  return n == 2;
}

// Row by row: corners and edges as the quadratic tetrahedron has them, bubbles 27 L L L of the
// facets and 256 L L L L of the cell; then each less its values at the later nodes, so that it is 1
// at its own node and 0 at all others.
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

// one at each corner, up to the middles of the edges, facets and cell; its neighbours in
// right-handed order
void add_parts_of_tetrahedron(ReferenceCell& cell) {
  constexpr int around[4][3] = {{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}};
  const auto middle = [&](std::initializer_list<int> corners) {
    Vec3 x = Vec3::Zero();
    for (int c : corners) x += cell.node[c] / static_cast<double>(corners.size());
    cell.parts.push_back(node_at(cell, x));
  };
  for (int i = 0; i < 4; ++i) {
    const auto [j, k, l] = around[i];
    middle({i});
    middle({i, j});
    middle({i, j, k});
    middle({i, k});
    middle({i, l});
    middle({i, j, l});
    middle({0, 1, 2, 3});
    middle({i, k, l});
  }
}

// 14 points of degree 5 with positive weights (N. J. Walkington, Quadrature on simplices of
// arbitrary dimension, 2000); on facets the 7 points of degree 5 (J. Radon, 1948)
ReferenceCell tetrahedron(const CellNames& names) {
  ReferenceCell cell = empty_row<Tet15>(names);
  cell.n_corners = 4;
  cell.facet_corners = 3;
  cell.layers = 0;
  cell.corner_shape = [](const Vec3& xi) -> VecX {
    return Eigen::Vector4d(1 - xi.sum(), xi[0], xi[1], xi[2]);
  };
  const Vec3 corner[4] = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  for (const Vec3& x : corner) cell.node.push_back(x);
  for (const auto& [a, b] : Tet15::edge) {
    cell.node.push_back((corner[a] + corner[b]) / 2);
    cell.edge.push_back({a, b});
  }
  for (const auto& [a, b, c] : Tet15::facet)
    cell.node.push_back((corner[a] + corner[b] + corner[c]) / 3);
  cell.node.push_back(Vec3::Constant(0.25));

  const auto add = [&](const Vec3& xi, double weight) {
    cell.gauss.push_back(xi);
    cell.weight.push_back(weight / 6);
  };
  for (const auto& [a, weight] : {std::pair{0.31088591926330060980, 0.11268792571801585080},
                                  {0.092735250310891226402, 0.073493043116361949544}})
    for (const Vec3& x : corner) add(Vec3::Constant(a) + (1 - 4 * a) * x, weight);
  constexpr double a = 0.045503704125649649492;
  for (const auto& [i, j] : Tet15::edge)
    add(Vec3::Constant(a) + (0.5 - 2 * a) * (corner[i] + corner[j]), 0.042546020777081466438);

  add_values(cell, [](const Vec3& xi) -> VecX { return Eigen::Vector4d(1, xi[0], xi[1], xi[2]); });
  for (int n = 0; n < cell.n_nodes; ++n) {
    const auto distance = [&](int g) {
      return (cell.gauss[g] - cell.node[n]).norm();
    };
    int nearest = 0;
    for (int g = 1; g < cell.n_gauss; ++g)
      if (distance(g) < distance(nearest) - 1e-12) nearest = g;
    cell.nearest_gauss.push_back(nearest);
  }
  add_parts_of_tetrahedron(cell);
  for (int f = 0; f < 4; ++f) {
    const auto& corners = Tet15::facet[f];
    std::vector<int> nodes(corners, corners + 3);
    for (int k = 0; k < 3; ++k) {
      const int one[2] = {corners[k], corners[(k + 1) % 3]};
      for (int e = 0; e < 6; ++e)
        if (std::min(one[0], one[1]) == Tet15::edge[e][0] &&
            std::max(one[0], one[1]) == Tet15::edge[e][1])
          nodes.push_back(4 + e);
    }
    nodes.push_back(10 + f);
    cell.facet.push_back(nodes);

    const Vec3 X[3] = {corner[corners[0]], corner[corners[1]], corner[corners[2]]};
    const Vec3 middle = cell.node[10 + f];
    std::vector<FacetPoint>& points = cell.facet_points.emplace_back();
    points.push_back({middle, 9. / 80, X[1] - X[0], X[2] - X[0]});
    for (double sign : {-1., 1.}) {
      const double b = (6 + sign * std::sqrt(15.)) / 21;
      const double weight = (155 + sign * std::sqrt(15.)) / 2400;
      for (const Vec3& x : X)
        points.push_back({3 * b * middle + (1 - 3 * b) * x, weight, X[1] - X[0], X[2] - X[0]});
    }
  }
  return cell;
}

// 0 to n - 1, and further ones
std::vector<int> in_order(int n, std::initializer_list<int> further = {}) {
  std::vector<int> nodes(static_cast<std::size_t>(n));
  std::iota(nodes.begin(), nodes.end(), 0);
  nodes.insert(nodes.end(), further);
  return nodes;
}

// One row for each type of element, in the order of CellType.
std::vector<ReferenceCell> rows() {
  const std::vector<int> sides{4, 5, 2, 1, 3, 0};
  const InAbaqus hex8{"C3D8", {{"C3D8", in_order(8)}}, sides};
  const InAbaqus hex27{
      nullptr,
      {{"C3D20", in_order(20)}, {"C3D27", in_order(20, {26, 24, 25, 22, 21, 23, 20})}},
      sides};
  const InAbaqus tet15{nullptr, {{"C3D4", in_order(4)}, {"C3D10", in_order(10)}}, in_order(4)};
  return {
      hexahedron<Hex8>(
          Hex8::corner, 1,
          {"hexahedra", "quadrangles", 12, "hexahedron", 5, 3, hex8, "hex8", "quad4", in_order(8)}),
      hexahedron<Hex27>(Hex27::node, 5. / 9,
                        {"hexahedra", "quadrangles", 29, "triquadratic hexahedron", 5, 3, hex27,
                         "hex27", "quad9", in_order(20, {22, 21, 23, 20, 24, 25, 26})}),
      tetrahedron({"tetrahedra",
                   "triangles",
                   71,
                   "Lagrange tetrahedron",
                   4,
                   2,
                   tet15,
                   nullptr,
                   nullptr,
                   {}}),
  };
}

}  // namespace

// Shape functions of the 15 nodes at a point.
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
  for (int e = 0; e < 6; ++e)
    dN.row(4 + e) = 4 * b.slope_of_product({edge[e][0], edge[e][1]}).transpose();
  for (int f = 0; f < 4; ++f)
    dN.row(10 + f) = 27 * b.slope_of_product({facet[f][0], facet[f][1], facet[f][2]}).transpose();
  dN.row(14) = 256 * b.slope_of_product({0, 1, 2, 3}).transpose();
  to_nodes(dN);
  return dN;
}

// Shape functions of the 27 nodes at a point, products of three polynomials.
Hex27::Shape Hex27::shape(const Vec3& xi) {
  Shape N;
  for (int a = 0; a < 27; ++a)
    N[a] = lagrange(node[a][0], xi[0]) * lagrange(node[a][1], xi[1]) * lagrange(node[a][2], xi[2]);
  return N;
}

Hex27::Gradient Hex27::gradient(const Vec3& xi) {
  Gradient dN;
  for (int a = 0; a < 27; ++a)
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3;
      const int j = (k + 2) % 3;
      dN(a, k) =
          slope(node[a][k], xi[k]) * lagrange(node[a][i], xi[i]) * lagrange(node[a][j], xi[j]);
    }
  return dN;
}

const std::vector<ReferenceCell>& reference_cells() {
  static const std::vector<ReferenceCell> all = rows();
  return all;
}

const ReferenceCell& reference(CellType type) {
  for (const ReferenceCell& cell : reference_cells())
    if (cell.type == type) return cell;
  throw std::logic_error("no reference cell of that type");
}

const ReferenceCell& reference(int n_nodes) {
  for (const ReferenceCell& cell : reference_cells())
    if (cell.n_nodes == n_nodes) return cell;
  throw std::logic_error("no reference cell has " + std::to_string(n_nodes) + " nodes");
}

}  // namespace langer
