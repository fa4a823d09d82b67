// Who made a file and from what: root attributes and /provenance of every HDF5 file.
#pragma once

#include <map>
#include <optional>
#include <string>

namespace langer {

// What a run of a program took; another run of the same takes a little more or less.
struct Cost {
  double cpu = 0;     // all threads [s]
  double wall = 0;    // [s]
  double memory = 0;  // at its peak [MB]
};

struct Identity {
  std::string stage;   // "mesh", "fit", "solve", ...
  std::string config;  // full effective YAML text
  std::string
      config_hash;  // FNV-1a 64 of `config` with input files by name: what they hold is in `inputs`
  std::map<std::string, std::string> inputs;  // port -> content id of the input file
  std::string command;                        // command line as typed
  std::optional<Cost>
      solution_cost;  // of the solution it is made of, where that took one run from start to end
  std::string steps_hash;  // of what in `config` decides whether kept steps are of this task;
                           // empty: all of it
};

// 16 hex digits of FNV-1a 64
std::string fnv1a(const std::string& text);

// content id of what a stage makes: hash of (stage, schema version, config_hash, ids of its inputs)
std::string content_id(const Identity& identity, int schema_version);

}  // namespace langer
