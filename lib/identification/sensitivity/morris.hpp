// Morris' screening [M91]: random paths through a grid of the box, one parameter moves at a time
// but each from another place, so that curvature and interactions show. The box is scaled to [0,
// 1]: effects carry the unit of the curve and compare.
//   effect   (y(x + Delta e_i) - y(x))/Delta on a grid of `levels` values, Delta = levels/(2 (levels - 1))
//   mu       mean of the effects;  mu_star mean of their sizes [CCS07];  sigma their standard deviation:
//            0 for a linear model, large where curved or where parameters act together
// Costs trajectories (k + 1) curves. Intervals by resampling whole trajectories.
#pragma once

#include "identification/sensitivity/sampling.hpp"

namespace langer {

struct Morris {
  Estimate mu, mu_star, sigma;          // (k, m)
  Estimate group_mu_star, group_sigma;  // (k, groups) means over the points of a group
  int trajectories = 0,
      without_curve = 0;  // of those asked for, left out because a curve does not exist
};

// lower < upper (k); levels even, >= 4; trajectories >= 2
Morris morris(const CurveMaker& maker, const VecX& lower, const VecX& upper, int trajectories,
              int levels, const SamplingOptions& options);

}  // namespace langer
