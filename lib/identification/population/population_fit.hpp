// The parameters of a population from the tests of its specimens: `specimens` in the config of a
// fit.
//
//   1. The curves of all specimens are averaged and fitted: where the search begins.
//   2. Each specimen is fitted alone: a first idea of the scatter.
//   3. The model with mixed effects (mixed_model.hpp) finds population, scatter and noise together.
// The first two are what is often reported. Both are biased where a law is not linear in its
// parameters, and stand beside the third for comparison.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "identification/setup/fit_config.hpp"
#include "results/store/material_file.hpp"

namespace langer {

struct PopulationFile {
  std::string name, text;
};

struct PopulationOutcome {
  // Why no population was found. Then there are only `files`, which say what the search reached.
  std::optional<Error> no_result;
  Material median;   // the law of the median specimen
  FitRecord record;  // parameters of the population, its scatter, the table `population`
  std::vector<PopulationFile> files;
  std::vector<std::string> lines, warnings;
};

// names of the files that a fit of a population writes
std::vector<std::string> population_files(const FitConfig& config);

// Throws Failure(config), Failure(input), Failure(not_converged). at: place of a key.
PopulationOutcome fit_population(const FitConfig& config,
                                 const std::function<Place(const std::string&)>& at,
                                 const std::function<void(const std::string&)>& say = {});

}  // namespace langer
