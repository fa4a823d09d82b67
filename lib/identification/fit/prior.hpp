// What was known of parameters before a fit, as further measurements: one value each,
//   normal     p       with a standard deviation in the unit of p
//   lognormal  ln p    with a standard deviation of its own
// A prior has a weight of its own beside the tests, so the weights of the tests have to be the
// inverse of their noise (weigh_by_noise()).
#pragma once

#include <memory>
#include <vector>

#include "identification/fit/fit.hpp"

namespace langer {

struct Prior {
  Eigen::Index number = 0;  // of the free parameters
  bool logarithm = false;
  double centre = 0;     // of p or of ln p
  double deviation = 1;  // likewise

  bool value(double p, double& x) const;  // p or ln p; false where there is none
  double slope(double p) const;           // of it
};

// `tests` may be empty.
std::shared_ptr<FurtherTests> with_priors(std::vector<Prior> priors,
                                          std::shared_ptr<FurtherTests> tests);

// Divides the weights of homogeneous tests by the noise that a fit without priors finds.
void weigh_by_noise(FitProblem& problem, const FitOptions& options);

}  // namespace langer
