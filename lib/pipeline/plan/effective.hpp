// The configs of all stages by name: what they really say once read (defaults filled in, includes
// and overrides resolved), and what can be said of them without a file: reference, top keys, JSON
// Schema.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/config/writer.hpp"
#include "pipeline/plan/names.hpp"
#include "pipeline/plan/ports.hpp"

namespace langer {

struct Effective {
  std::string text;  // canonical; paths of input files are relative to the folder given
  struct File {
    std::string path;  // relative to the working directory, or absolute
    std::string key;
    Place place;
  };
  std::vector<File> files;                // input files that the config names
  std::vector<std::string> notices = {};  // keys and words by their former names
  // Reads what is measured in them; throws Failure(input), gives what looks wrong in it. Empty:
  // nothing is measured.
  std::function<std::vector<std::string>()> look_at_data = {};
  SceneNames names = {};
};

struct ConfigKind {
  Effective (*check)(Tree config, const std::string& folder);  // throws Failure(config)
  std::string (*reference)();
  std::vector<DescribedKey> (*top_keys)();
  std::string (*schema)(const std::string& title);
};

// of a stage, or of a YAML file given at a port ("material"); nullptr where there is none
const ConfigKind* find_config_kind(const std::string& name);
std::vector<std::string> config_kind_names();

// Checks and canonical text of a stage's config, or of a YAML file given at a port; throws
// Failure(config).
Effective effective_config(const StageSpec& stage, Tree config, const std::string& folder);
Effective effective_port_file(const Port& port, Tree file, const std::string& folder);

}  // namespace langer
