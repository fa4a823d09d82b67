// The results of a design of experiments: effects.csv, lines of text, and bar charts.
#pragma once

#include <string>
#include <vector>

#include "pipeline/sweep/design.hpp"
#include "results/plot/heat_map.hpp"

namespace langer {

// One row per quantity and parameter. Cells of a method that the design does not have are empty.
std::string effects_csv(const Design& design, const std::vector<QuantityEffects>& effects);
// Lines for the log: the parameters by falling effect. A line about left-out samples begins with
// "warning: ".
std::vector<std::string> effects_lines(const Design& design, const QuantityEffects& effects);
// mu* of each method in the unit of the quantity.
Bars effects_bars(const Design& design, const QuantityEffects& effects);
// Sobol' indices.
Bars share_bars(const Design& design, const QuantityEffects& effects);

}  // namespace langer
