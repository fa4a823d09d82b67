// The only file of this room that includes the configs of all stages. Everything that depends on
// their types is compiled here, and used elsewhere through ConfigKind and read_stage_config().
#include "pipeline/plan/effective.hpp"

#include <utility>

#include "core/config/json_schema.hpp"
#include "identification/fit/doubts.hpp"
#include "identification/inverse/sample_config.hpp"
#include "identification/sensitivity/sensitivity_config.hpp"
#include "identification/setup/fit_config_io.hpp"
#include "layers/layers_config.hpp"
#include "mechanics/material/at_rest.hpp"
#include "pipeline/plan/run_files.hpp"
#include "pipeline/plan/stage_config.hpp"
#include "pipeline/sweep/gather_config.hpp"
#include "pipeline/sweep/tune_config.hpp"
#include "report/report_config.hpp"
#include "scene/model/material_review.hpp"
#include "scene/model/mesh_config.hpp"
#include "scene/model/solve_config.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/post_config.hpp"

namespace langer {

namespace {

void add_notices(Effective& e, const std::vector<std::string>& more) {
  e.notices.insert(e.notices.end(), more.begin(), more.end());
}

// Reads a config, and collects what a plan needs: the canonical text, the input files that it
// names, the names that other configs refer to, and checks of measured data.
template <Listed Config>
Effective check(Tree tree, const std::string& folder) {
  const Loaded<Config> loaded = read_config<Config>(std::move(tree));
  Effective e{to_yaml(loaded.config, relative_to(folder)), {}, loaded.notices};
  for (const NamedFile& file : files_named_by(loaded.config)) {
    const Place place = loaded.where(file.key);
    e.files.push_back({file.path, file.key, place});
    for (const std::string& included : files_included_by(file.path)) {
      e.files.push_back({included, file.key, place});
    }
  }
  if constexpr (std::is_same_v<Config, FitConfig>) {
    e.check_data = [config = loaded.config] {
      return doubts(measured_tests(config));
    };
    e.names = names_in(loaded.config.law);
  }
  if constexpr (std::is_same_v<Config, MeshConfig> || std::is_same_v<Config, Material>)
    e.names = names_in(loaded.config);
  if constexpr (std::is_same_v<Config, SolveConfig>)
    add_notices(e, review_lines(loaded.config, {}, loaded.where));
  if constexpr (std::is_same_v<Config, Material>)
    add_notices(e, review_lines(loaded.config, "", loaded.where));
  if constexpr (std::is_same_v<Config, SolveConfig> || std::is_same_v<Config, PostConfig>)
    e.names = names_in(loaded.config, loaded.where);
  return e;
}

// A material file that no fit made must be stiff in the undeformed state: otherwise the first
// tangent of a body made of it is singular.
Effective check_material(Tree tree, const std::string& folder) {
  const Loaded<Material> loaded = read_config<Material>(tree);
  if (at_rest(loaded.config) == AtRest::without_stiffness)
    throw Failure(
        Exit::config,
        Error{loaded.where("matrix"), "matrix", at_rest_in_words(loaded.config),
              stiffness_at_rest_cure(loaded.config), "a body without it has no first step"});
  return check<Material>(std::move(tree), folder);
}

template <Listed Config>
ConfigKind kind() {
  return {check<Config>, describe<Config>, top_keys<Config>, json_schema<Config>};
}

// The stages' config types. A new stage is added here, and at the end of this file.
const std::vector<std::pair<const char*, ConfigKind>>& kinds() {
  static const std::vector<std::pair<const char*, ConfigKind>> table{
      {"mesh", kind<MeshConfig>()},
      {"fit", kind<FitConfig>()},
      {"sample", kind<SampleConfig>()},
      {"sensitivity", kind<SensitivityConfig>()},
      {"solve", kind<SolveConfig>()},
      {"post", kind<PostConfig>()},
      {"layers", kind<LayersConfig>()},
      {"gather", kind<GatherConfig>()},
      {"report", kind<ReportConfig>()},
      {"tune", kind<TuneConfig>()},
      {"material", {check_material, describe<Material>, top_keys<Material>, json_schema<Material>}},
  };
  return table;
}

}  // namespace

const ConfigKind* find_config_kind(const std::string& name) {
  for (const auto& [known, kind] : kinds())
    if (name == known) return &kind;
  return nullptr;
}

std::vector<std::string> config_kind_names() {
  std::vector<std::string> names;
  for (const auto& [name, kind] : kinds()) names.push_back(name);
  return names;
}

Effective effective_config(const StageSpec& stage, Tree config, const std::string& folder) {
  return find_config_kind(stage.name)->check(std::move(config), folder);
}

Effective effective_port_file(const Port& port, Tree file, const std::string& folder) {
  return find_config_kind(port.name)->check(std::move(file), folder);
}

template <class Config>
ReadConfig read_stage_config(Tree tree, Config& config) {
  Loaded<Config> loaded = read_config<Config>(std::move(tree));
  config = std::move(loaded.config);
  return {std::move(loaded.where), std::move(loaded.notices), config_text(config),
          parts_of(config)};
}

template ReadConfig read_stage_config(Tree, MeshConfig&);
template ReadConfig read_stage_config(Tree, FitConfig&);
template ReadConfig read_stage_config(Tree, SampleConfig&);
template ReadConfig read_stage_config(Tree, SensitivityConfig&);
template ReadConfig read_stage_config(Tree, SolveConfig&);
template ReadConfig read_stage_config(Tree, PostConfig&);
template ReadConfig read_stage_config(Tree, LayersConfig&);
template ReadConfig read_stage_config(Tree, GatherConfig&);
template ReadConfig read_stage_config(Tree, ReportConfig&);
template ReadConfig read_stage_config(Tree, TuneConfig&);

}  // namespace langer
