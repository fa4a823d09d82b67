// Members of a sweep over fibre angles that may be mirror images of each other.
//
// With the angles alpha and 180 - alpha two scenes are images in a mirror; with alpha and
// 90 - alpha they are images if the body is square and the indenter round. One of them need not be
// solved. Plan does not know the geometry, so it only offers the solution of the earlier member to
// the later one, at its port `mirror`. langer-solve copies that solution if the scenes are images,
// and solves otherwise (scene/run/mirrored_solution.hpp).
//
// A solution is offered if configs and inputs differ in fibre_angles only, symmetry is not none,
// and the mesh and the errors do not depend on the member (no accuracy, fidelity, reduce,
// estimate). At most one is offered: one with 180 - alpha before one with 90 - alpha, because more
// scenes have that symmetry.
#pragma once

#include <vector>

#include "pipeline/plan/expand.hpp"

namespace langer::pipeline {

void offer_siblings(std::vector<Step>& steps);

}  // namespace langer::pipeline
