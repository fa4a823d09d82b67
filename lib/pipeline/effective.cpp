#include "pipeline/effective.hpp"

#include <map>

#include "config/reader.hpp"
#include "material/material.hpp"
#include "report/report_config.hpp"
#include "scene/fit_config.hpp"
#include "scene/gather_config.hpp"
#include "scene/mesh_config.hpp"
#include "scene/post_config.hpp"
#include "scene/sensitivity_config.hpp"
#include "scene/solve_config.hpp"

namespace langer {

namespace {

using Check = Effective (*)(Tree, const std::string& folder);

template <Listed Config>
Effective check(Tree tree, const std::string& folder) {
  const Loaded<Config> loaded = read_config<Config>(std::move(tree));
  Effective e{to_yaml(loaded.config, relative_to(folder)), {}};
  for (const NamedFile& file : files_named_by(loaded.config)) e.files.push_back({file.path, file.key, loaded.where(file.key)});
  return e;
}

}  // namespace

Effective effective_config(const StageSpec& stage, Tree config, const std::string& folder) {
  static const std::map<std::string, Check> checks{
      {"mesh", check<MeshConfig>},   {"fit", check<FitConfig>},   {"sensitivity", check<SensitivityConfig>},
      {"solve", check<SolveConfig>}, {"post", check<PostConfig>}, {"gather", check<GatherConfig>},
      {"report", check<ReportConfig>},
  };
  return checks.at(stage.name)(std::move(config), folder);
}

Effective effective_port_file(const Port& port, Tree file, const std::string& folder) {
  static const std::map<std::string, Check> checks{{"material", check<Material>}};
  return checks.at(port.name)(std::move(file), folder);
}

}  // namespace langer
