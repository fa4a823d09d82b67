// A figure of the config: columns of the table over another of its columns.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/input_path.hpp"
#include "results/plot/figure_units.hpp"
#include "results/plot/gnuplot.hpp"
#include "results/post/curves.hpp"

namespace langer {

// Points from a CSV file that the figure compares with computed columns.
struct FigurePoints {
  InputPath file;
  std::string x, y, legend;
  static void fields(auto& v) {
    v(&FigurePoints::file, "file", unit::none, "CSV file whose first line names its columns",
      required);
    v(&FigurePoints::x, "x", unit::none, "column in the unit of the figure's x", required);
    v(&FigurePoints::y, "y", unit::none, "column in the unit of the figure's y", required);
    v(&FigurePoints::legend, "legend", unit::none, "their text in the legend", required);
  }
};

struct PointColumns {
  std::vector<double> x, y;  // NaN where the file has no number
};
// Reads the points. `where` gives the place of one of their keys in the config. Throws
// Failure(config) for a column that the file lacks.
PointColumns read_points(const FigurePoints& points,
                         const std::function<Place(const std::string& key)>& where);

// The listing `figures`: one figure of columns.
struct FigureChoice {
  std::string x;
  std::vector<std::string> y, legends;
  std::string title;
  std::optional<std::string> x_label, y_label;
  std::optional<FigurePoints> points;
  AxisScale scale = AxisScale::linear;
  static void fields(auto& v) {
    v(&FigureChoice::x, "x", unit::none, "name of a column, without its unit", required);
    v(&FigureChoice::y, "y", unit::none, "names of one or more columns of the same unit", required);
    v(&FigureChoice::legends, "legends", unit::none,
      "one for each y; by default the quantities and places of the columns, or the names in the "
      "config");
    v(&FigureChoice::title, "title", unit::none, "above the figure");
    v(&FigureChoice::x_label, "x_label", unit::none, "label of x; the unit is added");
    v(&FigureChoice::y_label, "y_label", unit::none, "label of y; the unit is added");
    v(&FigureChoice::points, "points", unit::none,
      "measured or published points, drawn first; they are also written to <name>_points.csv");
    v(&FigureChoice::scale, "scale", unit::none, "axes that are logarithmic");
  }
};

// The quantity and the place of a column, or its name if the config gives one.
std::string legend_of(const ColumnChoice& choice);

// Their keys are relative to the figure: y[0], legends.
std::vector<Complaint> complaints(const FigureChoice& figure,
                                  const std::vector<ColumnChoice>& columns);

// The plot of a figure. `head` gives the head of a column in the CSV file from its name and unit.
Plot plot_of(const FigureChoice& figure, const std::vector<ColumnChoice>& columns,
             const std::string& csv,
             std::string (*head)(const std::string& name, const std::string& unit));

}  // namespace langer
