// Root attributes and /provenance of a file, and the check that a file is of the kind a reader
// expects.   docs/schema.md
#pragma once

#include <string>
#include <vector>

#include "core/hdf5/h5.hpp"
#include "results/store/identity.hpp"

namespace langer {

struct Schema {
  const char* name;
  int version;           // that files are written in
  int newest = version;  // that is read: of files with what the version before did not know
};
inline constexpr Schema mesh_schema{"mesh", 1, 3}, material_schema{"material", 1},
    solution_schema{"solution", 1, 3}, curves_schema{"curves", 1}, sweep_schema{"sweep", 1},
    sensitivity_schema{"sensitivity", 1}, snapshot_schema{"snapshot", 1};

std::string code_version();
std::string utc_now();  // SOURCE_DATE_EPOCH where that is set
std::string host_name();

// SOURCE_DATE_EPOCH, where set, is the time that /provenance/created_utc shows
// and at which what the work took is left out
void write_identity(const h5::Group& root, const Schema& schema, const Identity& identity);

Cost cost_so_far();  // of this program
// in place of what write_identity said when the file was begun; continued: earlier runs are not in
// it
void write_cost(const h5::Group& root, const Cost& cost, bool continued);

// refuses another schema or version by name; `config` and `command` stay empty where /provenance is
// missing
Identity read_identity(const h5::Group& root, const Schema& schema);
int schema_version(const h5::Group& root);

// a named number of the kind that gather collects into tables; group /summary, one scalar per name
struct Summary {
  std::string name;
  double value = 0;
  std::string unit;  // "-" for pure numbers
};
void write_summary(const h5::Group& root, const std::vector<Summary>& summary);
std::vector<Summary> read_summary(
    const h5::Group& root);  // ascending by name; none without /summary
std::vector<Summary> read_summary(const std::string& path);  // of any file of ours

// schema and identity of any file of ours
struct Origin {
  std::string schema;
  int version = 0;
  Identity identity;
  std::optional<Cost> cost;  // of the program that wrote it
  std::string content_id;
};
Origin read_origin(const std::string& path);

}  // namespace langer
