// The cost of a level of an accuracy, known before it is solved: from the symbolic analysis of its
// tangent (scene/run/dry_run.hpp). A level that needs more memory or time than is left is not
// begun.
#pragma once

#include <optional>
#include <string>

#include "scene/model/solve_config.hpp"
#include "scene/run/run.hpp"

namespace langer {

struct LevelCost {
  double seconds = 0;  // of CPU, its estimate included
  double bytes = 0, free = 0;
};
LevelCost level_cost(const SolveConfig& config, const std::optional<Material>& material,
                     const Run::Where& where);
// on this mesh, in place of the config's
LevelCost level_cost(const SolveConfig& config, const Mesh& mesh,
                     const std::optional<Material>& material, const Run::Where& where);
std::string in_words(const LevelCost& cost);  // "about 40 s of CPU and 430 MB"

// that the shell's ulimit -t and the job of a cluster leave this program; infinity where nothing
// limits it
double seconds_left();

// Why it is not to be begun, of memory and of seconds_left(); empty where it is.
std::string limit_exceeded(const LevelCost& cost, double left);

}  // namespace langer
