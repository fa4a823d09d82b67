// What is kept and what is said of a fit.
#pragma once

#include <string>
#include <vector>

#include "scene/fit_config.hpp"
#include "store/material_file.hpp"

namespace langer {

FitRecord fit_record(const FitConfig& config, const Curve& curve, const UniaxialFit& fit);

// strain, measured stress, model, error in percent of the largest stress (fig. 5 of [A23])
std::string fit_csv(const Curve& curve, const std::vector<double>& model);

// one line per parameter, one about the errors
std::vector<std::string> fit_results(const FitRecord& record);

// What a user of the parameters should know: negative moduli, parameters that the curve does not tell apart, and where the
// law loses strong ellipticity along the test, looked for up to half as far again as the curve goes.
std::vector<std::string> fit_warnings(const FitRecord& record, const Material& material);

}  // namespace langer
