#include "mechanics/element/surface.hpp"

#include <Eigen/Geometry>

#include "mechanics/element/geometry.hpp"

namespace langer {

VecX nodal_areas(const Mesh& mesh, const std::vector<Facet>& facets) {
  VecX areas = VecX::Zero(mesh.n_nodes());
  const ReferenceCell& reference_cell = mesh.cell();
  for (const Facet& facet : facets) {
    const auto cell = mesh.cell(facet.cell);
    const ElementNodes X = element_nodes(mesh, facet.cell);
    for (const FacetPoint& point : reference_cell.facet_points[facet.local]) {
      const VecX N = reference_cell.shape(point.xi);
      const Mat3 dX = X.transpose() * reference_cell.gradient(point.xi);
      const double area = point.weight * (dX * point.along_1).cross(dX * point.along_2).norm();
      for (int a : reference_cell.facet[facet.local]) areas[cell[a]] += N[a] * area;
    }
  }
  return areas;
}

void add_dead_traction(const Mesh& mesh, const std::vector<Facet>& facets, const Vec3& traction,
                       VecX& F) {
  const VecX areas = nodal_areas(mesh, facets);
  for (int i = 0; i < mesh.n_nodes(); ++i) F.segment<3>(3 * i) += areas[i] * traction;
}

namespace {

Mat3 cross_with(const Vec3& a) {  // a x
  Mat3 A;
  A << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return A;
}

// 1 where along_1 x along_2 of its points leads out of the cell, else -1
double outwards(const ReferenceCell& cell, int facet) {
  Vec3 out = Vec3::Zero();  // from the middle of the cell to that of the facet
  for (int k = 0; k < cell.facet_corners; ++k)
    out += cell.node[cell.facet[facet][k]] / cell.facet_corners;
  for (int a = 0; a < cell.n_corners; ++a) out -= cell.node[a] / cell.n_corners;
  const FacetPoint& point = cell.facet_points[facet].front();
  if (point.along_1.cross(point.along_2).dot(out) > 0) return 1;
  return -1;
}

// Shape functions of a facet's nodes at one of its Gauss points, and their derivatives along the
// facet. Those of the cell's other nodes vanish on the facet.
struct PointOfFacet {
  double weight;
  VecX N, dN_1, dN_2;  // in the order of ReferenceCell::facet
};

struct FacetShapes {
  double out;  // outwards()
  std::vector<PointOfFacet> points;
};

FacetShapes shapes_on(const ReferenceCell& cell, int facet) {
  const std::vector<int>& nodes = cell.facet[facet];
  FacetShapes shapes{outwards(cell, facet), {}};
  for (const FacetPoint& point : cell.facet_points[facet]) {
    const Gradients dN = cell.gradient(point.xi);
    shapes.points.push_back({point.weight, cell.shape(point.xi)(nodes),
                             VecX(dN * point.along_1)(nodes), VecX(dN * point.along_2)(nodes)});
  }
  return shapes;
}

// Of all facets of all cells, computed once.
const FacetShapes& facet_shapes(const ReferenceCell& cell, int facet) {
  static const std::vector<std::vector<FacetShapes>> all = [] {
    std::vector<std::vector<FacetShapes>> of_cells;
    for (const ReferenceCell& one : reference_cells()) {
      std::vector<FacetShapes>& of_facets = of_cells.emplace_back();
      for (int f = 0; f < one.n_facets(); ++f) of_facets.push_back(shapes_on(one, f));
    }
    return of_cells;
  }();
  const auto row = static_cast<std::size_t>(cell.type);
  return all[row][static_cast<std::size_t>(facet)];
}

// sum of c_a x_a over the nodes of a facet
Vec3 sum_over(const std::vector<int>& nodes, const VecX& c, const ElementNodes& x) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    sum += c[static_cast<Eigen::Index>(a)] * x.row(nodes[a]).transpose();
  }
  return sum;
}

}  // namespace

ElementNodes dead_traction(const ReferenceCell& cell, int facet, const ElementNodes& X,
                           const Vec3& traction) {
  ElementNodes f = ElementNodes::Zero(cell.n_nodes, 3);
  const std::vector<int>& nodes = cell.facet[facet];
  for (const PointOfFacet& p : facet_shapes(cell, facet).points) {
    const Vec3 X_1 = sum_over(nodes, p.dN_1, X);
    const Vec3 X_2 = sum_over(nodes, p.dN_2, X);
    const double area = p.weight * X_1.cross(X_2).norm();
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      f.row(nodes[a]) += p.N[static_cast<Eigen::Index>(a)] * area * traction.transpose();
    }
  }
  return f;
}

ElementNodes follower_pressure(const ReferenceCell& cell, int facet, const ElementNodes& x) {
  ElementNodes f = ElementNodes::Zero(cell.n_nodes, 3);
  const std::vector<int>& nodes = cell.facet[facet];
  const FacetShapes& shapes = facet_shapes(cell, facet);
  for (const PointOfFacet& p : shapes.points) {
    const Vec3 x_1 = sum_over(nodes, p.dN_1, x);
    const Vec3 x_2 = sum_over(nodes, p.dN_2, x);
    const Vec3 area = shapes.out * p.weight * x_1.cross(x_2);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      f.row(nodes[a]) -= p.N[static_cast<Eigen::Index>(a)] * area.transpose();
    }
  }
  return f;
}

// K = df/dx has the blocks  K_ab = -integral N_a (dN_b,2 [x,1 x] - dN_b,1 [x,2 x]).
MatX follower_stiffness(const ReferenceCell& cell, int facet, const ElementNodes& x) {
  const std::vector<int>& nodes = cell.facet[facet];
  const FacetShapes& shapes = facet_shapes(cell, facet);
  const auto n = static_cast<Eigen::Index>(nodes.size());
  MatX K = MatX::Zero(3 * n, 3 * n);  // of the nodes of the facet
  for (const PointOfFacet& p : shapes.points) {
    const Mat3 by_1 = p.weight * cross_with(sum_over(nodes, p.dN_1, x));
    const Mat3 by_2 = p.weight * cross_with(sum_over(nodes, p.dN_2, x));
    for (Eigen::Index b = 0; b < n; ++b) {
      const Mat3 along = p.dN_2[b] * by_1 - p.dN_1[b] * by_2;
      for (Eigen::Index a = 0; a < n; ++a) K.block<3, 3>(3 * a, 3 * b) -= p.N[a] * along;
    }
  }
  MatX out = MatX::Zero(3 * cell.n_nodes, 3 * cell.n_nodes);
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < n; ++b) {
      out.block<3, 3>(3 * nodes[static_cast<std::size_t>(a)],
                      3 * nodes[static_cast<std::size_t>(b)]) =
          0.5 * shapes.out *
          (K.block<3, 3>(3 * a, 3 * b) + K.block<3, 3>(3 * b, 3 * a).transpose());
    }
  }
  return out;
}

// (K - K^T) dx / 2, without K: at each Gauss point K dx needs dx,1 and dx,2, and K^T dx the
// movement of the point.
ElementNodes follower_skew_change(const ReferenceCell& cell, int facet, const ElementNodes& x,
                                  const ElementNodes& dx) {
  ElementNodes f = ElementNodes::Zero(cell.n_nodes, 3);
  const std::vector<int>& nodes = cell.facet[facet];
  const FacetShapes& shapes = facet_shapes(cell, facet);
  for (const PointOfFacet& p : shapes.points) {
    const Vec3 x_1 = sum_over(nodes, p.dN_1, x);
    const Vec3 x_2 = sum_over(nodes, p.dN_2, x);
    const Vec3 dx_1 = sum_over(nodes, p.dN_1, dx);
    const Vec3 dx_2 = sum_over(nodes, p.dN_2, dx);
    const Vec3 moved = sum_over(nodes, p.N, dx);
    const double half = 0.5 * shapes.out * p.weight;
    const Vec3 area = half * (dx_1.cross(x_2) + x_1.cross(dx_2));
    const Vec3 by_1 = half * x_1.cross(moved);
    const Vec3 by_2 = half * x_2.cross(moved);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const auto a = static_cast<Eigen::Index>(k);
      f.row(nodes[k]) -= (p.N[a] * area + p.dN_2[a] * by_1 - p.dN_1[a] * by_2).transpose();
    }
  }
  return f;
}

}  // namespace langer
