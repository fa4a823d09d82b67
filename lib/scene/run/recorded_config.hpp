// The config that a solution carries.
#pragma once

#include <optional>

#include "results/store/solution_file.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

// As one scene: supports, loads and surfaces of several bodies are those of the whole
// (scene/model/scene_bodies.hpp). Nothing where another version wrote it that this one cannot read.
std::optional<SolveConfig> recorded_config(const SolutionHeader& header);

}  // namespace langer
