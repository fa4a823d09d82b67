// The tables of a sensitivity study as CSV, and its report in words.
#pragma once

#include <string>
#include <vector>

#include "identification/sensitivity/sensitivity_file.hpp"

namespace langer {

MatX over_range(const SensitivityRecord& record,
                MatX effects);  // effects (upper - lower), row by row
std::vector<double> row(const MatX& A, std::size_t j);

std::string effects_csv(const SensitivityRecord& record);  // one at a time, one row per strain
// every method side by side, one row per parameter and zone
std::string zones_csv(const SensitivityRecord& record);
std::string morris_csv(const SensitivityRecord& record);  // one row per strain
std::string sobol_csv(const SensitivityRecord& record);

// one line per zone: the parameters by weight, what they do together, and what one-at-a-time
// effects miss
std::vector<std::string> sensitivity_lines(const SensitivityRecord& record);

}  // namespace langer
