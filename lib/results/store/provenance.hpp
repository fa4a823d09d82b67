// Root attributes and /provenance of a file, and the check that a file has the kind that a reader
// expects.   docs/schema.md
#pragma once

#include <string>
#include <vector>

#include "core/hdf5/h5.hpp"
#include "results/store/identity.hpp"

namespace langer {

// A kind of file and its version.
struct Schema {
  const char* name;
  int version;           // of files that are written
  int newest = version;  // of files that can be read: newer ones have parts that older ones lack
};
inline constexpr Schema mesh_schema{"mesh", 1, 3}, material_schema{"material", 1},
    solution_schema{"solution", 1, 3}, curves_schema{"curves", 1}, sweep_schema{"sweep", 1},
    sensitivity_schema{"sensitivity", 1}, snapshot_schema{"snapshot", 1};

std::string code_version();
std::string utc_now();  // SOURCE_DATE_EPOCH if that is set
std::string host_name();

// Writes stage, config, inputs and the cost so far. If SOURCE_DATE_EPOCH is set, it is the time
// in /provenance/created_utc and the cost is left out, so that two runs give the same bytes.
void write_identity(const h5::Group& root, const Schema& schema, const Identity& identity);

Cost cost_so_far();  // of this program
// Replaces the cost that write_identity wrote when the file was begun. `continued`: earlier runs
// are not included.
void write_cost(const h5::Group& root, const Cost& cost, bool continued);

// Refuses files of another schema or version by name. `config` and `command` are empty if
// /provenance is missing.
Identity read_identity(const h5::Group& root, const Schema& schema);
int schema_version(const h5::Group& root);

// A named number, which `gather` collects into tables. Group /summary has one scalar per name.
struct Summary {
  std::string name;
  double value = 0;
  std::string unit;  // "-" for pure numbers
};
void write_summary(const h5::Group& root, const std::vector<Summary>& summary);
// Ascending by name; empty without /summary.
std::vector<Summary> read_summary(const h5::Group& root);
std::vector<Summary> read_summary(const std::string& path);  // of any output of Langer

// Schema and identity of any output of Langer.
struct Origin {
  std::string schema;
  int version = 0;
  Identity identity;
  std::optional<Cost> cost;  // of the program that wrote it
  std::string content_id;
};
Origin read_origin(const std::string& path);

}  // namespace langer
