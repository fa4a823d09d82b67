// 95 % intervals of the parameters of a fit to tests.
//
// To first order an interval is the estimate and a number of standard errors to either side, or the
// profile of the linearised model where a bound is reached (within_bounds.hpp). This holds where
// the model is straight over the interval:
//   the likelihood at both of its ends, others following, is the one that the interval claims
// Where it is not, as of an angle near a symmetry, the interval is that of the profile. No interval
// leaves the box; an angle without bounds has none to leave.
#pragma once

#include <vector>

#include "identification/fit/fit.hpp"

namespace langer {

struct Interval {
  double low = 0, high = 0;  // NaN where it is not known
  bool by_profile = false;
};

// first: the intervals to first order, NaN where there is none
std::vector<Interval> intervals_95(const FitProblem& problem, const FitResult& fit,
                                   std::vector<Interval> first);

}  // namespace langer
