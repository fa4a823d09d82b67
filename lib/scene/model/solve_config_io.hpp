// Reading and writing of configs that some thirty sources ask for, compiled once: it took the
// compiler ten seconds in each.
#pragma once

#include "core/config/reader.hpp"
#include "core/config/writer.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

extern template Loaded<SolveConfig> read_config(Tree);
extern template Loaded<MeshConfig> read_config(Tree);
extern template Loaded<Material> read_config(Tree);
extern template Tree to_tree(const SolveConfig&, const PathText&);

}  // namespace langer
