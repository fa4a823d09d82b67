#include "mechanics/mesh/frames.hpp"

#include <Eigen/Geometry>

#include "mechanics/mesh/quality.hpp"

namespace langer {

std::vector<Mat3> frames(const Mesh& mesh, Frames kind) {
  if (kind == Frames::file) return mesh.frames;
  std::vector<Mat3> all(static_cast<std::size_t>(mesh.n_cells()), Mat3::Identity());
  if (kind == Frames::global) return all;
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const Mat3 edges = jacobian(mesh, e, Vec3::Zero());
    Mat3& frame = all[e];
    frame.col(0) = edges.col(0).normalized();
    frame.col(2) = frame.col(0).cross(edges.col(1)).normalized();
    frame.col(1) = frame.col(2).cross(frame.col(0));
  }
  return all;
}

}  // namespace langer
