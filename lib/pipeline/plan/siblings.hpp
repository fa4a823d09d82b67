// Members of a sweep over fibre angles that may be images of each other: alpha and 180 - alpha in a
// mirror, alpha and 90 - alpha on a square body under a round indenter. Geometry is not known here:
// the later one gets the earlier one's solution at its port `mirror`, and langer-solve copies it
// where the scenes are images, or solves (mirror/mirror.hpp).
//   offered   where configs and inputs differ in fibre_angles alone, symmetry is not none, and cells or errors are not the member's own
//             (accuracy, fidelity, reduce, estimate)
// One is offered at most: by alpha and 180 - alpha before 90 degrees more or less, as fewer scenes
// have that symmetry.
#pragma once

#include <vector>

#include "pipeline/plan/expand.hpp"

namespace langer::pipeline {

void offer_siblings(std::vector<Step>& steps);

}  // namespace langer::pipeline
