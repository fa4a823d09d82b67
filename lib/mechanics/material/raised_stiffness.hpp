// What a fit did where the tests hardly determine the shear modulus at rest: it raised a lower
// bound. The fit computes this record (identification/fit/stiffness_at_rest.hpp); material files
// keep it.
#pragma once

#include <string>

namespace langer {

struct StiffnessAtRest {
  double fitted = 0;   // shear modulus that the tests put at rest [MPa]
  double allowed = 0;  // up to here chi-square stays within 3.84 of its minimum, others following;
                       // infinity: no end was found
  double least = 0;    // as above
  double taken = 0;    // of the law in the end
  double noise = 0;    // of a residual [MPa]; times the weight where there is one
  std::string key;     // of the number whose bound was raised
  double error_before = 0, error_after = 0;  // mean errors [%]: what the bound costs
};

}  // namespace langer
