#include "element/surface.hpp"

#include <Eigen/Geometry>

#include "element/geometry.hpp"

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

void add_dead_traction(const Mesh& mesh, const std::vector<Facet>& facets, const Vec3& traction, VecX& F) {
  const VecX areas = nodal_areas(mesh, facets);
  for (int i = 0; i < mesh.n_nodes(); ++i) F.segment<3>(3 * i) += areas[i] * traction;
}

}  // namespace langer
