// Values at places on a plane as coloured squares, in panels one below the other: what was measured
// there, what was found, how they differ. Panels of one limit have one scale.
#pragma once

#include <string>
#include <vector>

#include "results/plot/drawing.hpp"

namespace langer {

struct FieldPanel {
  std::string title;
  std::vector<double> values;  // of each place; NaN: grey
  double limit = 1;            // colours from -limit to limit: blue below zero, red above
};

struct FieldMap {
  std::string title, x_label, y_label, unit;
  std::vector<double> x, y;  // of each place
  std::vector<FieldPanel> panels;
};

Drawing field_map(const FieldMap& map);

}  // namespace langer
