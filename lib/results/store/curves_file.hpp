// curves.h5: named curves, a table of columns, maps of the surface and a summary; table and maps
// also as CSV beside it. CSV columns are called name_unit (name alone for pure numbers); what is
// not a number is an empty cell. docs/schema.md
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "results/store/identity.hpp"
#include "results/store/provenance.hpp"

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

using PlanePoint = std::array<double, 2>;  // x, z

// A field on a part of the surface in one state, seen from above: x to the right, z downwards.
struct SurfaceMap {
  std::string name, label, unit;
  double t = 0;                            // of the state
  std::vector<PlanePoint> places;          // x, z of the nodes, undeformed [mm]
  std::vector<double> values;              // at the nodes
  std::vector<std::array<int, 4>> facets;  // corners, in order round
  std::vector<PlanePoint> fibres;  // x, z of the first family's direction in each facet's cell
  std::map<std::string, PlanePoint> points;  // named places
};

struct Curves {
  std::vector<NamedCurve> curves;
  std::vector<Column> columns;  // of equal length
  std::vector<SurfaceMap> maps;
  std::vector<Summary> summary;
};

// writes `path` and, where there are columns, the CSV of the same name first
void write_curves(const std::string& path, const Curves& curves, const Identity& identity);

struct CurvesFile {
  Curves curves;  // curves, maps and summary ascending by name, columns in the order written
  std::string content_id;
};
CurvesFile read_curves(const std::string& path);

std::string csv_name(const std::string& name,
                     const std::string& unit);  // "1/MPa" becomes per_MPa, "N mm" N_mm
std::string csv_cell(const std::string& text);  // between quotes where it holds a comma, a quote, a
                                                // semicolon, a line's end or outer blanks
std::string csv(const std::vector<Column>& columns);
std::vector<Column> columns_of(const SurfaceMap& map);  // x, z, value: one row per node

}  // namespace langer
