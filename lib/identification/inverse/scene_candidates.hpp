// Candidates of the advice (fit/advice.hpp) that are scenes: one run of each with the derivatives
// by the free parameters, at what the fit found. Each value counts with its standard deviation, so
// that `noise` is 1.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "identification/fit/advice.hpp"
#include "identification/fit/fit.hpp"
#include "identification/setup/fit_config.hpp"

namespace langer {

struct SceneCandidates {
  std::vector<Candidate> candidates;  // J (values, free parameters)
  std::vector<std::string> without;   // those whose scene has no end, in words
};

// of config.study; throws Failure(config) at the key that does not fit the scene
SceneCandidates scene_candidates(const FitConfig& config, const FitProblem& problem,
                                 const FitResult& fit,
                                 const std::function<Place(const std::string&)>& where);

}  // namespace langer
