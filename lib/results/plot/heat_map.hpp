// A matrix as coloured cells with a scale, and groups of bars.
// Rows are counted upwards or downwards; the axes have names or numbers.
#pragma once

#include <string>
#include <vector>

#include "core/tensor/types.hpp"
#include "results/plot/drawing.hpp"

namespace langer {

// The matrix with its names and the settings of its scale.
struct HeatMap {
  std::string title, x_label, y_label, value_label;
  // One name for each column and row. Empty: the axes have numbers, from the range below.
  std::vector<std::string> x_names, y_names;
  double x_from = 0, x_to = 1, y_from = 0, y_to = 1;  // centres of the first and last cells
  MatX values;                                        // NaN cells are grey
  // The scale is -limit to limit: blue below zero, red above. Larger values have the colour of the
  // end.
  double limit = 1;
  // Not 0: the scale is linear about 0 and logarithmic beyond about a third of this value.
  double middle = 0;
  bool swap_colours = false;      // red below zero instead of above
  bool losses = false;            // values from 0 to limit, small ones red; no scale is drawn
  bool numbers = false;           // the values are written into the cells
  bool zero_line = false;         // a line between cells of different sign
  bool first_row_on_top = false;  // otherwise it is at the bottom
};

Drawing heat_map(const HeatMap& map, const Look& look = {});

// Groups of bars with error bars: one group for each column of the values, one bar of each series
// in a group.
struct Bars {
  std::string title, y_label;
  std::vector<std::string> groups, series;
  MatX values, low, high;  // (series, groups); low and high may be empty
};
Drawing bars(const Bars& bars, const Look& look = {});

}  // namespace langer
