// curves.h5: named curves, a table of columns and a summary; the table also as CSV beside it.        docs/schema.md
// CSV columns are called name_unit (name alone for pure numbers).
#pragma once

#include <string>
#include <vector>

#include "store/identity.hpp"
#include "store/provenance.hpp"

namespace langer {

struct NamedCurve {
  std::string name;
  std::string x_label, x_unit;
  std::string y_label, y_unit;
  std::vector<double> x, y;
};

struct Column {
  std::string name, unit;
  std::vector<double> values;
};

struct Curves {
  std::vector<NamedCurve> curves;
  std::vector<Column> columns;  // of equal length
  std::vector<Summary> summary;
};

// writes `path` and, where there are columns, the CSV of the same name first
void write_curves(const std::string& path, const Curves& curves, const Identity& identity);

struct CurvesFile {
  Curves curves;  // curves and summary ascending by name, columns in the order written
  std::string content_id;
};
CurvesFile read_curves(const std::string& path);

std::string csv_name(const std::string& name, const std::string& unit);  // "1/MPa" becomes per_MPa
std::string csv(const std::vector<Column>& columns);

}  // namespace langer
