// A figure as the user asks for it: columns of the table over another of its columns.
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

// Points from a CSV file beside what was computed.
struct FigurePoints {
  InputPath file;
  std::string x, y, legend;
  static void fields(auto& v) {
    v(&FigurePoints::file, "file", unit::none, "CSV file whose first line names its columns",
      required);
    v(&FigurePoints::x, "x", unit::none, "column in the unit of the figure's x", required);
    v(&FigurePoints::y, "y", unit::none, "column in the unit of the figure's y", required);
    v(&FigurePoints::legend, "legend", unit::none, "what they are", required);
  }
};

struct PointColumns {
  std::vector<double> x, y;  // NaN where the file has no number
};
// where(key): of the points. Throws Failure(config) for a column that the file lacks.
PointColumns read_points(const FigurePoints& points,
                         const std::function<Place(const std::string& key)>& where);

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
      "one for each y; by default what the columns show and where, or the names that they were given");
    v(&FigureChoice::title, "title", unit::none, "above the figure");
    v(&FigureChoice::x_label, "x_label", unit::none, "what x is; the unit is added");
    v(&FigureChoice::y_label, "y_label", unit::none, "what y is; the unit is added");
    v(&FigureChoice::points, "points", unit::none,
      "measured or published points, drawn first; they also stand in <name>_points.csv");
    v(&FigureChoice::scale, "scale", unit::none, "axes that are logarithmic");
  }
};

std::string legend_of(
    const ColumnChoice& choice);  // what it shows and where; the name where the config gives one

// keys relative to the figure: y[0], legends
std::vector<Complaint> complaints(const FigureChoice& figure,
                                  const std::vector<ColumnChoice>& columns);

// heads(name, unit) gives the head of a column in the CSV file
Plot plot_of(const FigureChoice& figure, const std::vector<ColumnChoice>& columns,
             const std::string& csv,
             std::string (*head)(const std::string& name, const std::string& unit));

}  // namespace langer
