// What looks doubtful in the materials of a scene (material/review.hpp), as lines with the place of
// the key.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

// of_file: the material of --material, for bodies that have none in the config
std::vector<std::string> review_lines(const SolveConfig& config,
                                      const std::optional<Material>& of_file,
                                      const std::function<Place(const std::string&)>& where);

// of one material; its keys begin with `prefix`
std::vector<std::string> review_lines(const Material& material, const std::string& prefix,
                                      const std::function<Place(const std::string&)>& where);

}  // namespace langer
