// Reference cells: nodes in VTK order, shape functions, Gauss points, facets.
//   Hex8   on [-1, 1]^3:  N_a = (1 + xi xi_a)(1 + eta eta_a)(1 + zeta zeta_a) / 8;  2 x 2 x 2 Gauss points of weight 1
//   Hex27  on [-1, 1]^3:  N_a = l_a(xi) l_a(eta) l_a(zeta), quadratic Lagrange polynomials through -1, 0, 1;
//          corners as Hex8, then the middles of edges, of facets (in the order of the facets), of the cell; 3 x 3 x 3 Gauss points
//   Tet15  on xi, eta, zeta >= 0, xi + eta + zeta <= 1: quadratic polynomials, and bubbles on facets and in the cell, so that
//          every node of a facet has a positive share of a pressure on it (a quadratic facet's corners have none);
//          corners, middles of the edges 01 12 02 03 13 23, of the facets, of the cell; 14 Gauss points, of degree 5
// Gauss point g of a hexahedron lies towards node g.
// A new type of cell: its struct and its word in `Cells` here, its tables in reference.cpp, its
// name in mesh.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "mechanics/mesh/mesh.hpp"

namespace langer {

struct Hex8 {
  static constexpr CellType type = CellType::hex8;
  static constexpr int n_nodes = 8;
  static constexpr int n_gauss = 8;
  static constexpr int n_dofs = 24;
  // xi_a, eta_a, zeta_a
  static constexpr double corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                          {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  // nodes of local facet f, counter-clockwise seen from outside; 0 -xi, 1 +xi, 2 -eta, 3 +eta, 4
  // -zeta, 5 +zeta
  static constexpr int facet[6][4] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                      {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};

  using Shape = Eigen::Matrix<double, 8, 1>;
  using Gradient = Eigen::Matrix<double, 8, 3>;

  static Shape shape(const Vec3& xi) {
    Shape N;
    for (int a = 0; a < 8; ++a)
      N[a] = 0.125 * (1 + corner[a][0] * xi[0]) * (1 + corner[a][1] * xi[1]) *
             (1 + corner[a][2] * xi[2]);
    return N;
  }

  // dN_a/dxi_k
  static Gradient gradient(const Vec3& xi) {
    Gradient dN;
    for (int a = 0; a < 8; ++a) {
      const double f[3] = {1 + corner[a][0] * xi[0], 1 + corner[a][1] * xi[1],
                           1 + corner[a][2] * xi[2]};
      dN(a, 0) = 0.125 * corner[a][0] * f[1] * f[2];
      dN(a, 1) = 0.125 * corner[a][1] * f[0] * f[2];
      dN(a, 2) = 0.125 * corner[a][2] * f[0] * f[1];
    }
    return dN;
  }

  static Vec3 gauss(int g) {
    return Vec3(corner[g][0], corner[g][1], corner[g][2]) / std::sqrt(3.0);
  }
  static double weight(int) { return 1; }
};

struct Hex27 {
  static constexpr CellType type = CellType::hex27;
  static constexpr int n_nodes = 27;
  static constexpr int n_gauss = 27;
  static constexpr int n_dofs = 81;
  static constexpr double node[27][3] = {
      {-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1},
      {-1, 1, 1},                                          // corners
      {0, -1, -1},  {1, 0, -1},  {0, 1, -1}, {-1, 0, -1},  // edges: bottom,
      {0, -1, 1},   {1, 0, 1},   {0, 1, 1},  {-1, 0, 1},   // top,
      {-1, -1, 0},  {1, -1, 0},  {1, 1, 0},  {-1, 1, 0},   // upright
      {-1, 0, 0},   {1, 0, 0},   {0, -1, 0}, {0, 1, 0},   {0, 0, -1},  {0, 0, 1},  {0, 0, 0}};

  using Shape = Eigen::Matrix<double, 27, 1>;
  using Gradient = Eigen::Matrix<double, 27, 3>;

  static Shape shape(const Vec3& xi);
  static Gradient gradient(const Vec3& xi);
  static Vec3 gauss(int g) { return std::sqrt(0.6) * Vec3(node[g][0], node[g][1], node[g][2]); }
  static double weight(int g) {
    double w = 1;
    for (double x : node[g]) {
      if (x == 0) {
        w *= 8. / 9;
      } else {
        w *= 5. / 9;
      }
    }
    return w;
  }
};

struct Tet15 {
  static constexpr CellType type = CellType::tet15;
  static constexpr int n_nodes = 15;
  static constexpr int n_gauss = 14;
  static constexpr int n_dofs = 45;
  static constexpr int edge[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
  // corners counter-clockwise seen from outside; their middles are nodes 10 to 13
  static constexpr int facet[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

  using Shape = Eigen::Matrix<double, 15, 1>;
  using Gradient = Eigen::Matrix<double, 15, 3>;

  static Shape shape(const Vec3& xi);
  static Gradient gradient(const Vec3& xi);
};

using Gradients = Eigen::Matrix<double, Eigen::Dynamic, 3>;  // one row per node

// A Gauss point of a facet: area = weight |dX/dxi along_1 x dX/dxi along_2|
struct FacetPoint {
  Vec3 xi;
  double weight;
  Vec3 along_1, along_2;
};

// A cell of Abaqus and CalculiX that is read as one of ours. Letters after the name (C3D8R,
// C3D10MH) do not change its nodes.
struct AbaqusCell {
  const char* name;
  std::vector<int>
      order;  // our node by theirs: all, the corners, or these and the middles of edges
};

struct InAbaqus {
  const char* written;           // none: not written there
  std::vector<AbaqusCell> read;  // what becomes this cell
  std::vector<int> sides;        // our facets by theirs, S1 first
};

// What a cell, the one of first order with its corners, and its facets are called elsewhere; none:
// not written there.
struct CellNames {
  const char *shape, *facet_shape;  // "hexahedra", "quadrangles"
  int vtk;
  const char* vtk_word;
  int gmsh, gmsh_facet;  // of first order, as meshes from files are
  InAbaqus abaqus;
  const char *febio, *febio_facet;
  std::vector<int> febio_order;  // our node by theirs
};

// Any of them as tables, for code that works with every type of cell.
struct ReferenceCell {
  CellType type;
  CellNames names;
  int n_nodes, n_gauss, n_corners;  // corners are the first nodes
  int facet_corners;
  int layers;  // of nodes along zeta; 0 in a tetrahedron, whose edges stand for no direction
  std::vector<Vec3> node, gauss;  // xi
  std::vector<double> weight;
  std::vector<VecX> N;        // at the Gauss points
  std::vector<Gradients> dN;  // dN_a/dxi_k there
  VecX (*shape)(const Vec3& xi);
  Gradients (*gradient)(const Vec3& xi);
  VecX (*corner_shape)(
      const Vec3& xi);  // shape functions of the corners alone: trilinear, in a tetrahedron linear
  std::vector<std::array<int, 2>> edge;  // its corners
  std::vector<std::vector<int>> facet;   // nodes: the corners counter-clockwise from outside, then
                                         // middles of edges in that order, then the middle
  std::vector<std::vector<FacetPoint>> facet_points;
  MatX at_nodes;  // (nodes, Gauss points): the best trilinear (linear in a tetrahedron) field of
                  // Gauss values, taken at the nodes
  std::vector<int> nearest_gauss;  // by node
  std::vector<int> parts;  // hexahedra between neighbouring nodes that together are the cell, eight
                           // nodes for each

  bool hexahedron() const { return layers > 0; }
  bool second_order() const { return n_nodes > n_corners; }
  int n_facets() const { return static_cast<int>(facet.size()); }
};

const std::vector<ReferenceCell>& reference_cells();
const ReferenceCell& reference(int n_nodes);  // the one with so many

using Cells = std::tuple<Hex8, Hex27, Tet15>;
inline constexpr int most_nodes =
    std::apply([](auto... cell) { return std::max({decltype(cell)::n_nodes...}); }, Cells{});
inline constexpr int most_gauss =
    std::apply([](auto... cell) { return std::max({decltype(cell)::n_gauss...}); }, Cells{});
inline constexpr int most_dofs = 3 * most_nodes;

// on(Hex8()), or whichever has so many nodes: for loops whose sizes the compiler must know
template <class On>
void with_cell(int n_nodes, const On& on) {
  const auto is_it = [&](auto cell) {
    if (decltype(cell)::n_nodes != n_nodes) return false;
    on(cell);
    return true;
  };
  if (!std::apply([&](auto... cell) { return (is_it(cell) || ...); }, Cells{}))
    throw std::logic_error("no reference cell has " + std::to_string(n_nodes) + " nodes");
}

}  // namespace langer
