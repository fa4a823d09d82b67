// A report as values, and as one HTML file that needs no other file: styles, scripts, three.js and
// the data are inside, so it opens offline and can be sent by mail.
//   answers   what was done, and the resulting force
//   verdicts  whether the results can be trusted: equilibrium, stability, contact, errors
//   charts    curves with values under the pointer
//   polars    results over an angle
//   matrices  correlations
//   maps      values over a plane
//   tables    numbers
//   bodies    deformed bodies in 3D
//   origins   which program made which file from which inputs
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "report/answer.hpp"
#include "report/json.hpp"
#include "report/report_symmetry.hpp"

namespace langer::report {

// good: checked and right; note: worth knowing; warning: the result may be wrong.
enum class Level { good, note, warning };

// One judgement of a result, in a sentence.
struct Verdict {
  Level level = Level::note;
  std::string of, text;  // of: the file or member that it concerns
};

// One curve of a chart.
struct Series {
  std::string name;
  std::vector<double> x, y;
  bool points = false;             // measured values are drawn as points, not as a line
  std::vector<double> error = {};  // half width of a band about the line; empty: none
};

// Curves over a common x. Charts of one group are shown together.
struct Chart {
  std::string group, title, x_label, x_unit, y_label, y_unit;
  std::vector<Series> series;
  bool ordered = false;  // the series are values of a number: colours in order
  struct Mark {
    std::string name;
    double y = 0;
  };
  std::vector<Mark> marks = {};  // lines that the curves are compared with
};

// A square matrix of correlations.
struct Matrix {
  std::string title;
  std::vector<std::string> names;           // of rows and columns
  std::vector<std::vector<double>> values;  // -1 to 1; NaN: not known
};

// Values over a square of x and y, colours by sign and logarithm.
struct PlaneMap {
  std::string title, x_label, y_label, label, unit;
  std::vector<double> at;                   // of both axes, evenly
  std::vector<std::vector<double>> values;  // rows along y
  double middle = 1;                        // value of a medium colour
};

// The head of a column, and a cell, which is a number or a text.
struct TableColumn {
  std::string name, unit;
};
using Cell = std::variant<double, std::string>;
struct ReportTable {
  std::string title;
  std::vector<TableColumn> columns;
  std::vector<std::vector<Cell>> rows;
};

// Results over an angle, with the symmetries that they should have.
struct Polar {
  std::string title, axis, unit;
  std::vector<double> angle;   // [deg]
  std::vector<Series> series;  // y by angle
  std::vector<SymmetryResidual> residuals;
};

// The provenance of one file.
struct FileOrigin {
  std::string label, stage, made, host, version, libraries, command, content, config;
  double wall = 0, cpu = 0;  // [s]; NaN if the file does not contain them
};

// The whole page, in the order in which it is shown.
struct ReportPage {
  std::string title;
  std::vector<Answer> answers;
  std::vector<Verdict> verdicts;
  std::vector<Chart> charts;
  std::vector<Polar> polars;
  std::vector<Matrix> matrices;
  std::vector<PlaneMap> maps;
  std::vector<ReportTable> tables;
  std::vector<Json> bodies;  // body_view.hpp
  std::vector<FileOrigin> origins;
};

// The page as text of HTML.
std::string html(const ReportPage& page);
bool has_three();  // this build has three.js inside; without it a page has no view of the body
std::size_t bytes_without_data();

}  // namespace langer::report
