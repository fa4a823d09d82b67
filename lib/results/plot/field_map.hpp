// Values at places of a plane as coloured squares, in panels one below the other: measured values,
// computed values and their difference. Panels with the same limit have the same scale.
#pragma once

#include <string>
#include <vector>

#include "results/plot/drawing.hpp"

namespace langer {

// The values that one panel shows.
struct FieldPanel {
  std::string title;
  std::vector<double> values;  // one for each place; NaN is grey
  double limit = 1;            // colours from -limit to limit: blue below zero, red above
};

// Panels over the same places.
struct FieldMap {
  std::string title, x_label, y_label, unit;
  std::vector<double> x, y;  // of each place
  std::vector<FieldPanel> panels;
};

Drawing field_map(const FieldMap& map);

}  // namespace langer
