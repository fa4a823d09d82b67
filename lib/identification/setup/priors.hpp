// The priors of a fit's parameters, as numbers.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "identification/fit/prior.hpp"
#include "identification/setup/fit_config.hpp"

namespace langer {

// Reads the files that priors name: of a population the scatter between its specimens, of a fit
// estimate and standard error. Throws Failure(config) where a file does not know the parameter.
std::vector<Prior> priors_of(const FitConfig& config, const FitProblem& problem,
                             const std::function<Place(const std::string&)>& at);

}  // namespace langer
