// The origin of a file: which program made it and from what. Every HDF5 file has it as root
// attributes and in /provenance.
#pragma once

#include <map>
#include <optional>
#include <string>

namespace langer {

// The cost of a run. Another run of the same task costs a little more or less.
struct Cost {
  double cpu = 0;     // all threads [s]
  double wall = 0;    // [s]
  double memory = 0;  // at its peak [MB]
};

// The identity of a run, from which the content id of its output follows.
struct Identity {
  std::string stage;   // "mesh", "fit", "solve", ...
  std::string config;  // full effective YAML text
  // FNV-1a 64 of `config` with the names of the input files; their contents are in `inputs`.
  std::string config_hash;
  std::map<std::string, std::string> inputs;  // port -> content id of the input file
  std::string command;                        // command line as typed
  // The cost of the solution that it is made from, if one run computed it from start to end.
  std::optional<Cost> solution_cost;
  // Hash of the keys of `config` that decide whether kept steps belong to this task; empty: of all
  // keys.
  std::string steps_hash;
};

// 16 hex digits of FNV-1a 64
std::string fnv1a(const std::string& text);

// The content id of an output: the hash of stage, schema version, config_hash and the ids of the
// inputs.
std::string content_id(const Identity& identity, int schema_version);

}  // namespace langer
