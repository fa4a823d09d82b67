// The study of a fit: identifiability, the best next test, where the material is stable;
// as records, words and tables.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "identification/fit/advice.hpp"
#include "identification/fit/fit.hpp"
#include "identification/statistics/study_config.hpp"
#include "results/store/study_record.hpp"

namespace langer {

using ProgressOf = std::function<std::function<void(double)>(const std::string& what)>;

// names of the free parameters, as the tables call them
std::vector<std::string> parameter_names(const FitProblem& problem);

FittedRange fitted_range(const Material& material, const std::vector<Test>& tests);
// scenes: candidates of the advice beside those of the config, with the columns of all free
// parameters (inverse/scene_candidates.hpp)
StudyRecord study(const FitProblem& problem, const FitResult& fit, const StudyConfig& config,
                  const ProgressOf& progress = {}, const std::vector<Candidate>& scenes = {});

std::vector<std::string> study_lines(const StudyRecord& study);

struct TextFile {
  std::string name, text;
};
// identifiability.csv, advice.csv, profile_<name>.csv, stability.csv, stability_plane.csv
std::vector<TextFile> study_tables(const StudyRecord& study);

}  // namespace langer
