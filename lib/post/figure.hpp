// A figure as the user asks for it: columns of the table over another of its columns.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plot/gnuplot.hpp"
#include "post/curves.hpp"

namespace langer {

struct FigureChoice {
  std::string x;
  std::vector<std::string> y, legends;
  std::string title;
  std::optional<std::string> x_label, y_label;
  static void fields(auto& v) {
    v(&FigureChoice::x, "x", unit::none, "name of a column, without its unit", required);
    v(&FigureChoice::y, "y", unit::none, "names of one or more columns of the same unit", required);
    v(&FigureChoice::legends, "legends", unit::none, "one for each y; by default the names of the columns");
    v(&FigureChoice::title, "title", unit::none, "above the figure");
    v(&FigureChoice::x_label, "x_label", unit::none, "what x is; the unit is added");
    v(&FigureChoice::y_label, "y_label", unit::none, "what y is; the unit is added");
  }
};

std::string with_unit(const std::string& label, const std::string& unit);  // "travel (mm)"

// keys relative to the figure: y[0], legends
std::vector<Complaint> complaints(const FigureChoice& figure, const std::vector<ColumnChoice>& columns);

// heads(name, unit) gives the head of a column in the CSV file
Plot plot_of(const FigureChoice& figure, const std::vector<ColumnChoice>& columns, const std::string& csv,
             std::string (*head)(const std::string& name, const std::string& unit));

}  // namespace langer
