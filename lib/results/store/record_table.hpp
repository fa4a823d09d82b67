// A table that a study leaves in material.h5: laws that were compared, parameters of a population,
// quantiles of a posterior. `langer-gather` with `rows: <name>` makes it a table of its own.
//   /tables/<name>/<column>   (rows) f64 with `unit`; NaN where a row has no value
//                             attribute `rows` of the group: names of the rows, one a line;
//                             `row`: what a row is; `columns`: names in their order, one a line
#pragma once

#include <string>
#include <vector>

#include "core/hdf5/h5.hpp"

namespace langer {

struct RecordColumn {
  std::string name, unit;
  std::vector<double> values;
};

struct RecordTable {
  std::string name;               // laws, population, posterior
  std::string row;                // head of the first column: law, parameter
  std::vector<std::string> rows;  // its texts
  std::vector<RecordColumn> columns;

  // the column of this name, made if it is not there
  RecordColumn& column(const std::string& wanted, const std::string& unit = "-");
};

// With a header; numbers with as many digits as they need, empty where there is none. Units that
// are no pure number stand behind the name of their column.
std::string csv(const RecordTable& table);

void write_tables(const h5::Group& root, const std::vector<RecordTable>& tables);
std::vector<RecordTable> read_tables(const h5::Group& root);

}  // namespace langer
