// A matrix as coloured cells with a scale: rows upwards or downwards, names or numbers at the axes.
#pragma once

#include <string>
#include <vector>

#include "core/tensor/types.hpp"
#include "results/plot/drawing.hpp"

namespace langer {

struct HeatMap {
  std::string title, x_label, y_label, value_label;
  std::vector<std::string> x_names,
      y_names;  // one per column and row, or empty where x and y are given
  double x_from = 0, x_to = 1, y_from = 0, y_to = 1;  // of the outer cells' centres
  MatX values;                                        // NaN cells are grey
  double limit = 1;  // of the scale, -limit to limit: blue below zero, red above; larger values
                     // have the end's colour
  double middle =
      0;  // not 0: the scale is logarithmic beyond about a third of this value, and linear about 0
  bool swap_colours = false;  // red below zero: for what is lost there
  bool losses = false;        // values from 0 to limit, the smaller the redder; no scale
  bool numbers = false;       // written into the cells
  bool zero_line = false;     // between cells of different sign
  bool first_row_on_top = false;
};

Drawing heat_map(const HeatMap& map, const Look& look = {});

// Groups of bars with intervals.
struct Bars {
  std::string title, y_label;
  std::vector<std::string> groups, series;
  MatX values, low, high;  // (series, groups); low and high may be empty
};
Drawing bars(const Bars& bars, const Look& look = {});

}  // namespace langer
