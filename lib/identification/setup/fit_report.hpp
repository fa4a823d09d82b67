// The record of a fit, and its report in words and tables.
#pragma once

#include <string>
#include <vector>

#include "identification/setup/fit_config.hpp"
#include "results/store/material_file.hpp"

namespace langer {

FitRecord fit_record(const FitProblem& problem, const FitResult& fit);

// One table of all tests: strain, measured stress, model, error in percent of the test's largest
// stress (fig. 5 of [A23]). One uniaxial test has the columns strain, <measure>_stress, model,
// error; otherwise there is a column for each of
//   test (its number in the list, from 1), first, second, stress_x, stress_z, model_x, model_z, error_x, error_z
// and missing z columns are NaN.
std::string fit_csv(const FitRecord& record);

// one line per parameter, one about the errors
std::vector<std::string> fit_results(const FitRecord& record);

// What a user of the parameters should know: negative moduli, parameters that the curve does not
// tell apart, and where the law loses strong ellipticity along the test, looked for up to half as
// far again as the curve goes.
std::vector<std::string> fit_warnings(const FitRecord& record, const Material& material);

}  // namespace langer
