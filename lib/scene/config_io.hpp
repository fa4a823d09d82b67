// Reading and writing the configs of meshes, laws and scenes, made once: some thirty sources ask for it, and each that made it for itself
// took the compiler ten seconds more.
#pragma once

#include "config/reader.hpp"
#include "config/writer.hpp"
#include "scene/solve_config.hpp"

namespace langer {

extern template Loaded<SolveConfig> read_config(Tree);
extern template Loaded<MeshConfig> read_config(Tree);
extern template Loaded<Material> read_config(Tree);
extern template Tree to_tree(const SolveConfig&, const PathText&);
extern template void collect_files(const SolveConfig&, const std::string&, std::vector<NamedFile>&);

}  // namespace langer
