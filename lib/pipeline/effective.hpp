// The config that a step really runs with: read by its listing, defaults filled in, includes and overrides resolved.
#pragma once

#include <string>
#include <vector>

#include "config/writer.hpp"
#include "pipeline/ports.hpp"

namespace langer {

struct Effective {
  std::string text;  // canonical; paths of input files are relative to the folder given
  struct File {
    std::string path;  // relative to the working directory, or absolute
    std::string key;
    Place place;
  };
  std::vector<File> files;  // input files that the config names
};

// Checks and canonical text of a stage's config, or of a YAML file given at a port; throws Failure(config).
Effective effective_config(const StageSpec& stage, Tree config, const std::string& folder);
Effective effective_port_file(const Port& port, Tree file, const std::string& folder);

}  // namespace langer
