// The mesh that a solve config is solved on.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/model/solve_config.hpp"

namespace langer {

// Of the file, or where that is empty the one that the config describes. Throws Failure(input) for
// a mesh that is folded or torn, Failure(config) at the key of the mesh that cannot be made.
// notes: receives what was read otherwise than a geometry's file says.
Mesh body_mesh(const SolveConfig& config, const std::string& file,
               const std::function<Place(const std::string&)>& where,
               std::vector<std::string>* notes = nullptr);

}  // namespace langer
