// Whether a scene is the image of another one on the same mesh, or of itself, under a symmetry of
// that mesh.
//   fibres      the set of (law, a a^T) of each cell goes over into that of its image: families may change places, as those at +theta
//               and -theta do in a mirror; a family without direction (kappa: 1/3) has nothing to turn
//   supports, imposed displacements, forces on the surface    the image's, turned
//   indenters   each goes over into itself or into another of the same shape and friction, that moves as its image does
#pragma once

#include <string>
#include <vector>

#include "mechanics/mesh/mirror_image.hpp"
#include "scene/model/scene.hpp"

namespace langer {

struct SceneImage {
  std::string broken;        // what is not the image; empty where nothing
  std::vector<int> contact;  // image of each
};
SceneImage image_of(const MeshImage& g, const Mesh& mesh, const Scene& scene, const Scene& image);

}  // namespace langer
