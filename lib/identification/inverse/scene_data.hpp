// The measured file of a scene: columns as numbers in mm, N, MPa and s, whatever the file says.
//   CSV (base/csv_table.hpp), or curves.h5 of langer-post
// Refused, with file, line and column: unknown columns, units of another kind, text where a number
// should be, no rows.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "identification/setup/fit_config.hpp"

namespace langer {

struct SceneColumn {
  std::string key;     // of FitColumns: u_ind, force, ...
  std::string header;  // as the file calls it
  std::string unit;    // mm, N, MPa, s or -
  std::vector<double> values;
  Place place;  // of the header
};

struct SceneData {
  std::string name;
  std::vector<SceneColumn> columns;  // those that the config names
  std::vector<Place> rows;
  const SceneColumn* find(const std::string& key) const;
};

SceneData read_scene_data(const FitData& data, const std::string& file);  // throws Failure(input)

// What a quantity is measured in, by the key of its column.
const char* unit_of_column(const std::string& key);

}  // namespace langer
