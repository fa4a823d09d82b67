// The forces on the surface that a config asks for, on the facets of a mesh.
#pragma once

#include <functional>
#include <vector>

#include "core/base/error.hpp"
#include "mechanics/assembly/loads.hpp"
#include "mechanics/mesh/mesh.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

// Errors at their keys: a set without facets, a force along what supports hold, a direction that a
// section does not have.
std::vector<SurfaceLoad> surface_loads(const SolveConfig& config, const Mesh& mesh,
                                       const std::function<Place(const std::string&)>& where,
                                       std::vector<Error>& errors);

}  // namespace langer
