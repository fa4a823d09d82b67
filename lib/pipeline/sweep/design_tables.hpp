// What a design of experiments has told: effects.csv, lines for the reader, bars for each quantity.
#pragma once

#include <string>
#include <vector>

#include "pipeline/sweep/design.hpp"
#include "results/plot/heat_map.hpp"

namespace langer {

// one row per quantity and parameter; empty where a method was not asked for
std::string effects_csv(const Design& design, const std::vector<QuantityEffects>& effects);
std::vector<std::string> effects_lines(const Design& design, const QuantityEffects& effects);
Bars effects_bars(const Design& design,
                  const QuantityEffects& effects);  // mu* of each method, in the quantity's unit
Bars share_bars(const Design& design, const QuantityEffects& effects);  // Sobol's

}  // namespace langer
