// Config of sample: which of the sets of parameters that a fit leaves open
// (inverse/parameter_sample.hpp).
#pragma once

#include "core/base/fields.hpp"

namespace langer {

struct SampleConfig {
  int number = 1;
  static void fields(auto& v) {
    v(&SampleConfig::number, "number", unit::none,
      "of the set: one of the fit's bootstrap, or drawn by its covariance within the bounds; a pipeline's axis {samples: 100} has them all",
      between(1, 10000));
  }
};

}  // namespace langer
