// The configs of all stages by name.
//
// The effective config is a config as the stage uses it: defaults are filled in, includes and
// overrides are resolved, keys are in a fixed order. Two configs with the same effective text mean
// the same computation, whatever their comments and order. For each kind of config there are also
// a reference (--describe), a list of the top keys (--help) and a JSON Schema (editors).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/config/writer.hpp"
#include "pipeline/plan/names.hpp"
#include "pipeline/plan/ports.hpp"

namespace langer {

// A config that was read and checked, as a plan needs it.
struct Effective {
  std::string text;  // canonical; paths of input files are relative to the folder given
  struct File {
    std::string path;  // relative to the working directory, or absolute
    std::string key;
    Place place;
  };
  std::vector<File> files;                // input files that the config names
  std::vector<std::string> notices = {};  // keys and words by their former names
                                          // Reads the measured data in the files and returns
                                          // warnings about them; throws Failure(input).
  // Empty for a config without measured data.
  std::function<std::vector<std::string>()> check_data = {};
  SceneNames names = {};
};

// The functions of one kind of config, without its C++ type.
struct ConfigKind {
  Effective (*check)(Tree config, const std::string& folder);  // throws Failure(config)
  std::string (*reference)();
  std::vector<DescribedKey> (*top_keys)();
  std::string (*schema)(const std::string& title);
};

// The kind of config of a stage, or of a YAML file given at a port ("material"); nullptr for an
// unknown name.
const ConfigKind* find_config_kind(const std::string& name);
std::vector<std::string> config_kind_names();

// Checks and canonical text of a stage's config, or of a YAML file given at a port; throws
// Failure(config).
Effective effective_config(const StageSpec& stage, Tree config, const std::string& folder);
Effective effective_port_file(const Port& port, Tree file, const std::string& folder);

}  // namespace langer
