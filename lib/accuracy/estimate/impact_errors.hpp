// Errors of what an impact leaves behind: peak force, contact time, restitution
// (scene/run/impact_results.hpp).
//
// The scene is solved twice more, with elements and increments that are both longer by one factor,
// so that a wave crosses an element in as many increments as before. The three values of a result
// follow
//   q = f + A h^p,    p at most 2 and as they show it (accuracy/estimate/observed_law.hpp)
// The error is q - f, with the factor of safety of an order that is only observed. Values that show
// no order have twice their largest difference for a bar. Nodes come into contact one by one: no
// bar is shorter than the share that this makes of the peak force.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/estimate/error_estimate.hpp"

namespace langer {

bool is_of_impact(const std::string& quantity);

// found, path: results and forces of the run itself. Throws as estimate_errors().
PathErrors impact_errors(const SolveConfig& config, const std::optional<Material>& material,
                         const std::function<Place(const std::string&)>& where,
                         const std::vector<Summary>& found, const std::vector<StepForces>& path,
                         const EstimateListener& listener);

}  // namespace langer
