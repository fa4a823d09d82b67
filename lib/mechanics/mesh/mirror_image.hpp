// A mesh as its own image under a mirror or a turn:  X' = centre + S (X - centre),  S orthogonal.
#pragma once

#include <optional>
#include <vector>

#include "mechanics/mesh/mesh.hpp"

namespace langer {

struct MeshImage {
  Mat3 turn = Mat3::Identity();  // S
  Vec3 centre = Vec3::Zero();    // [mm]
  std::vector<int> node, cell;   // image of each
};

// Nothing where a node or cell has no image, or the image belongs to another body. Positions agree
// within 1e-9 of the size.
std::optional<MeshImage> find_image(const Mesh& mesh, const Mat3& turn, const Vec3& centre);

}  // namespace langer
