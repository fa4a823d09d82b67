#include "identification/setup/fit_config_io.hpp"

namespace langer {

template Loaded<FitConfig> read_config(Tree);
template Tree to_tree(const FitConfig&, const PathText&);

}  // namespace langer
