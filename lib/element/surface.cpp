#include "element/surface.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "element/reference.hpp"

namespace langer {

void add_dead_traction(const Mesh& mesh, const std::vector<Facet>& facets, const Vec3& traction, VecX& F) {
  // 2 x 2 Gauss points on the bilinear facet
  constexpr double corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (const Facet& facet : facets) {
    const auto cell = mesh.cell(facet.cell);
    const int* local = Hex8::facet[facet.local];
    for (const auto& g : corner) {
      const double xi = g[0] / std::sqrt(3.0), eta = g[1] / std::sqrt(3.0);
      double N[4];
      Vec3 t1 = Vec3::Zero(), t2 = Vec3::Zero();
      for (int a = 0; a < 4; ++a) {
        N[a] = 0.25 * (1 + corner[a][0] * xi) * (1 + corner[a][1] * eta);
        t1 += 0.25 * corner[a][0] * (1 + corner[a][1] * eta) * mesh.X[cell[local[a]]];
        t2 += 0.25 * corner[a][1] * (1 + corner[a][0] * xi) * mesh.X[cell[local[a]]];
      }
      const double area = t1.cross(t2).norm();
      for (int a = 0; a < 4; ++a) F.segment<3>(3 * cell[local[a]]) += N[a] * area * traction;
    }
  }
}

}  // namespace langer
