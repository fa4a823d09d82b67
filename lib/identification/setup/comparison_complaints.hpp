// What is wrong with `laws`, `discover`, `specimens` and priors of a fit, beyond single keys.
#pragma once

#include <vector>

#include "identification/setup/fit_config.hpp"

namespace langer {

std::vector<Complaint> comparison_complaints(const FitConfig& config);

}  // namespace langer
