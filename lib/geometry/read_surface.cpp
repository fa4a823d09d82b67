#include "geometry/read_surface.hpp"

#include <gmsh.h>

#include <Eigen/Geometry>
#include <map>

#include "geometry/session.hpp"

namespace langer {

SurfaceFile read_surface(const std::string& path) {
  const auto refuse = [&](const std::string& found) -> void {
    throw Failure(Exit::input, Error{{path}, "", found, "an STL file with triangles, normals outwards", ""});
  };
  SurfaceFile surface;
  const GmshSession session;
  try {
    gmsh::merge(path);
  } catch (const std::exception& e) {
    refuse("cannot be read as a surface");
  }
  std::vector<std::size_t> tags, nodes;
  std::vector<double> X, parametric;
  gmsh::model::mesh::getNodes(tags, X, parametric);
  std::map<std::size_t, int> index;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    index[tags[i]] = static_cast<int>(i);
    surface.points.emplace_back(X[3 * i], X[3 * i + 1], X[3 * i + 2]);
    if (!surface.points.back().allFinite()) refuse("a position that is not finite");
  }
  gmsh::model::mesh::getElementsByType(2, tags, nodes);  // 3-node triangles
  for (std::size_t t = 0; t < tags.size(); ++t) {
    std::array<int, 3> c;
    for (int k = 0; k < 3; ++k) c[k] = index.at(nodes[3 * t + k]);
    const Vec3 ab = surface.points[c[1]] - surface.points[c[0]], ac = surface.points[c[2]] - surface.points[c[0]];
    if (!(ab.cross(ac).norm() > 1e-14 * ab.norm() * ac.norm())) refuse("triangle " + std::to_string(t + 1) + " has no area");
    surface.corners.push_back(c);
  }
  if (surface.corners.empty()) refuse("no triangles");
  return surface;
}

}  // namespace langer
