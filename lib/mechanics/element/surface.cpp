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

// on(N, dN/d1, dN/d2, x,1, x,2, weight) at each Gauss point of the facet
void at_facet_points(const ReferenceCell& cell, int facet, const ElementNodes& x, auto&& on) {
  for (const FacetPoint& point : cell.facet_points[facet]) {
    const Gradients dN = cell.gradient(point.xi);
    const VecX dN_1 = dN * point.along_1;
    const VecX dN_2 = dN * point.along_2;
    on(cell.shape(point.xi), dN_1, dN_2, Vec3(x.transpose() * dN_1), Vec3(x.transpose() * dN_2),
       point.weight);
  }
}

}  // namespace

ElementNodes dead_traction(const ReferenceCell& cell, int facet, const ElementNodes& X,
                           const Vec3& traction) {
  ElementNodes f = ElementNodes::Zero(cell.n_nodes, 3);
  at_facet_points(
      cell, facet, X,
      [&](const VecX& N, const VecX&, const VecX&, const Vec3& X_1, const Vec3& X_2, double w) {
        const double area = w * X_1.cross(X_2).norm();
        for (int a : cell.facet[facet]) f.row(a) += N[a] * area * traction.transpose();
      });
  return f;
}

ElementNodes follower_pressure(const ReferenceCell& cell, int facet, const ElementNodes& x) {
  ElementNodes f = ElementNodes::Zero(cell.n_nodes, 3);
  const double out = outwards(cell, facet);
  at_facet_points(
      cell, facet, x,
      [&](const VecX& N, const VecX&, const VecX&, const Vec3& x_1, const Vec3& x_2, double w) {
        const Vec3 area = out * w * x_1.cross(x_2);
        for (int a : cell.facet[facet]) f.row(a) -= N[a] * area.transpose();
      });
  return f;
}

MatX follower_stiffness(const ReferenceCell& cell, int facet, const ElementNodes& x) {
  MatX K = MatX::Zero(3 * cell.n_nodes, 3 * cell.n_nodes);
  at_facet_points(cell, facet, x,
                  [&](const VecX& N, const VecX& dN_1, const VecX& dN_2, const Vec3& x_1,
                      const Vec3& x_2, double w) {
                    const Mat3 by_1 = w * cross_with(x_1);
                    const Mat3 by_2 = w * cross_with(x_2);
                    for (int a : cell.facet[facet])
                      for (int b : cell.facet[facet])
                        K.block<3, 3>(3 * a, 3 * b) -= N[a] * (dN_2[b] * by_1 - dN_1[b] * by_2);
                  });
  return 0.5 * outwards(cell, facet) * (K + K.transpose());
}

ElementNodes follower_pressure_change(const ReferenceCell& cell, int facet, const ElementNodes& x,
                                      const ElementNodes& dx) {
  ElementNodes f = ElementNodes::Zero(cell.n_nodes, 3);
  const double out = outwards(cell, facet);
  at_facet_points(cell, facet, x,
                  [&](const VecX& N, const VecX& dN_1, const VecX& dN_2, const Vec3& x_1,
                      const Vec3& x_2, double w) {
                    const Vec3 dx_1 = dx.transpose() * dN_1;
                    const Vec3 dx_2 = dx.transpose() * dN_2;
                    const Vec3 area = out * w * (dx_1.cross(x_2) + x_1.cross(dx_2));
                    for (int a : cell.facet[facet]) f.row(a) -= N[a] * area.transpose();
                  });
  return f;
}

}  // namespace langer
