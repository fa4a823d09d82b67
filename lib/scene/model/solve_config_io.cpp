#include "scene/model/solve_config_io.hpp"

namespace langer {

template Loaded<SolveConfig> read_config(Tree);
template Loaded<MeshConfig> read_config(Tree);
template Loaded<Material> read_config(Tree);
template Tree to_tree(const SolveConfig&, const PathText&);

}  // namespace langer
