// Shares of the variance of a curve when the parameters vary independently and evenly over their
// box.  [S10], [J99]
//   first   S_i = V(E(y | x_i))/V(y): the part that x_i explains alone
//   total   T_i = E(V(y | all but x_i))/V(y): with everything it takes part in; T_i - S_i is interaction
// From two samples A, B of n rows, which a Sobol' sequence of 2 k dimensions or independent random
// numbers give, and A with its column i from B:
//   S_i V = mean y_B (y_ABi - y_A)        T_i V = mean (y_A - y_ABi)^2 / 2         n (k + 2) curves
// A group of points has the sums of its points' numerators over the sum of their variances: a large
// stress counts more. Intervals by resampling blocks of rows, as if they were independent: sums are
// kept for each block, not the curves.
#pragma once

#include "identification/sensitivity/sampling.hpp"

namespace langer {

struct Sobol {
  Estimate first, total;              // (k, m); NaN at points without variance
  Estimate group_first, group_total;  // (k, groups)
  VecX mean, deviation;               // (m) of the curve over the box
  long rows = 0,
       without_curve = 0;  // rows used, rows left out because one of their curves does not exist
  long curves = 0;         // computed
};

// lower < upper (k); n >= 64 rows
Sobol sobol(const CurveMaker& maker, const VecX& lower, const VecX& upper, long n,
            const SamplingOptions& options);

}  // namespace langer
