#include "scene/run/recorded_config.hpp"

#include "scene/model/scene_bodies.hpp"
#include "scene/model/solve_config_io.hpp"

namespace langer {

std::optional<SolveConfig> recorded_config(const SolutionHeader& header) {
  try {
    Tree tree = parse_yaml(header.identity.config, "the solution's config");
    SolveConfig config = read_config<SolveConfig>(tree).config;
    expand_bodies(config, tree);
    return config;
  } catch (const Failure&) {
    return std::nullopt;
  }
}

}  // namespace langer
