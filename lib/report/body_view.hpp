// The deformed body of a solution as data of a page: places, displacements and fields of its nodes
// in several states, the facets of its surface, fibres, and the indenters pressed into it.
//   displacement  int16, one unit is `step` mm     fields  uint16 between their least and largest value over all states
//   fibre         F a = sum_k x_k (grad N_k . a) at the middle of a cell: eight weights per glyph, so that a fibre can be drawn
//                 at any state and scale; it is drawn at the middle of a facet
//   cells         with all nodes, so that a plane can cut the body open; left out if the budget is too small
#pragma once

#include <string>
#include <vector>

#include "report/json.hpp"
#include "report/report_config.hpp"
#include "results/store/solution_file.hpp"

namespace langer::report {

// The view has at most `budget` bytes, unless two states of the surface need more. It has fewer
// states first, then only the surface.
Json body_view(const std::string& label, const SolutionReader& solution, const std::string& path,
               const ReportConfig& config, double budget);

// The modes that a solution holds, each as a body of its own whose states are one oscillation: that
// of the first critical point, and natural vibrations. Surfaces only, and as many modes as the
// budget has room for.
std::vector<Json> mode_views(const std::string& label, const SolutionReader& solution,
                             const VibrationRecord& record, double budget);

}  // namespace langer::report
