// Config -> mesh with sets and frames.
// Throws Failure(config) with the place of the key: a folded cell, a point without node, an empty
// set.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "mechanics/mesh/quality.hpp"
#include "scene/model/mesh_config.hpp"

namespace langer {

struct MadeMesh {
  Mesh mesh;
  Quality quality;
  std::vector<std::string> notes;    // details, such as moved grid lines
  std::vector<std::string> of_file;  // what was read otherwise than the geometry's file says
};

MadeMesh make_mesh(const MeshConfig& config, const std::function<Place(const std::string&)>& where);

}  // namespace langer
