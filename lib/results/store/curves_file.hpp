// curves.h5: named curves, a table of columns, maps of the surface and a summary. The table and the
// maps are also written as CSV into the same folder. CSV columns are called name_unit, or name
// alone for pure numbers; a value that is not a number is an empty cell. docs/schema.md
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "results/store/identity.hpp"
#include "results/store/provenance.hpp"

namespace langer {

// A curve with the labels and units of its axes.
struct NamedCurve {
  std::string name;
  std::string x_label, x_unit;
  std::string y_label, y_unit;
  std::vector<double> x, y;
};

// A column of the table.
struct Column {
  std::string name, unit;
  std::vector<double> values;
};

using PlanePoint = std::array<double, 2>;  // x, z

// A field on a part of the surface in one state, seen from above: x to the right, z downwards.
struct SurfaceMap {
  std::string name, label, unit;
  double t = 0;                            // path parameter of the state
  std::vector<PlanePoint> places;          // x, z of the nodes, undeformed [mm]
  std::vector<double> values;              // at the nodes
  std::vector<std::array<int, 4>> facets;  // corners in order
  std::vector<PlanePoint> fibres;  // x, z of the first family's direction in each facet's cell
  std::map<std::string, PlanePoint> points;  // named places
};

// The contents of curves.h5.
struct Curves {
  std::vector<NamedCurve> curves;
  std::vector<Column> columns;  // of equal length
  std::vector<SurfaceMap> maps;
  std::vector<Summary> summary;
};

// Writes `path`. If there are columns, the CSV file of the same name is written first.
void write_curves(const std::string& path, const Curves& curves, const Identity& identity);

struct CurvesFile {
  Curves curves;  // curves, maps and summary ascending by name, columns in the order written
  std::string content_id;
};
CurvesFile read_curves(const std::string& path);

// The head of a column: "1/MPa" becomes name_per_MPa, "N mm" name_N_mm.
std::string csv_name(const std::string& name, const std::string& unit);
// The text of a cell. It is quoted if it has a comma, a quote, a semicolon, an end of line or outer
// blanks.
std::string csv_cell(const std::string& text);
std::string csv(const std::vector<Column>& columns);
std::vector<Column> columns_of(const SurfaceMap& map);  // x, z, value: one row per node

}  // namespace langer
