#include "element/surface.hpp"

#include <Eigen/Geometry>

#include "element/geometry.hpp"

namespace langer {

VecX nodal_areas(const Mesh& mesh, const std::vector<Facet>& facets) {
  VecX areas = VecX::Zero(mesh.n_nodes());
  const ReferenceCell& reference_cell = reference(nodes_per_cell(mesh.type));
  for (const Facet& facet : facets) {
    const auto cell = mesh.cell(facet.cell);
    const ElementNodes X = element_nodes(mesh, facet.cell);
    // n x n Gauss points of the facet: those of the cell, moved onto its plane
    const int axis = facet.local / 2;
    const double side = facet.local % 2 == 0 ? -1 : 1;
    for (int g = 0; g < reference_cell.n_gauss; ++g) {
      Vec3 xi = reference_cell.gauss[g];
      if (xi[axis] * side < 0.5) continue;  // one layer of them
      double weight = reference_cell.weight[g];
      weight /= reference_cell.n_nodes == 8 ? 1 : 5. / 9;
      xi[axis] = side;
      const VecX N = reference_cell.shape(xi);
      const Mat3 dX = X.transpose() * reference_cell.gradient(xi);
      const double area = dX.col((axis + 1) % 3).cross(dX.col((axis + 2) % 3)).norm();
      for (int a : reference_cell.facet[facet.local]) areas[cell[a]] += weight * N[a] * area;
    }
  }
  return areas;
}

void add_dead_traction(const Mesh& mesh, const std::vector<Facet>& facets, const Vec3& traction, VecX& F) {
  const VecX areas = nodal_areas(mesh, facets);
  for (int i = 0; i < mesh.n_nodes(); ++i) F.segment<3>(3 * i) += areas[i] * traction;
}

}  // namespace langer
