// Tables and figures of a study (statistics/study.hpp) and of a sensitivity study, beside the main
// output of their stage.
//   correlation, profiles, stability_plane, stability_directions       effects, effects_by_zone, morris_by_zone, sobol_by_zone
#pragma once

#include <string>
#include <vector>

#include "identification/sensitivity/sensitivity_file.hpp"
#include "identification/statistics/study.hpp"
#include "results/plot/figure_style.hpp"
#include "results/store/material_file.hpp"

namespace langer {

// Both return a line for every figure that could not be drawn.
std::vector<std::string> write_study_files(const StudyRecord& study, const StudyConfig& config,
                                           const FigureStyle& style, const std::string& folder);
// Figures of one uniaxial test, from fit.csv: figs 4 and 5 of [A23].
std::vector<std::string> draw_fit(const std::string& measured_column, const FigureStyle& style,
                                  const std::string& folder);
// of fit_<name>.csv of each curve and field that was measured in scenes: measured and found over
// what it was measured over, errors; of fields maps at the end, map_<name>
std::vector<std::string> draw_curves(const std::vector<FittedCurve>& curves,
                                     const FigureStyle& style, const std::string& folder);
std::vector<std::string> draw_sensitivity(const SensitivityRecord& record, const FigureStyle& style,
                                          const std::string& folder);

}  // namespace langer
