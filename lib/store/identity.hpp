// Who made a file and from what: root attributes and /provenance of every HDF5 file.
#pragma once

#include <map>
#include <string>

namespace langer {

struct Identity {
  std::string stage;                          // "mesh", "fit", "solve", ...
  std::string config;                         // full effective YAML text
  std::string config_hash;                    // FNV-1a 64 of `config` with input files by name: what they hold is in `inputs`
  std::map<std::string, std::string> inputs;  // port -> content id of the input file
  std::string command;                        // command line as typed
};

// 16 hex digits of FNV-1a 64
std::string fnv1a(const std::string& text);

// content id of what a stage makes: hash of (stage, schema version, config_hash, ids of its inputs)
std::string content_id(const Identity& identity, int schema_version);

}  // namespace langer
