// Which numbers of a material are ranked, between which bounds: the config's, or those of the fit
// the material comes from.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "identification/sensitivity/sensitivity_config.hpp"
#include "identification/sensitivity/sensitivity_file.hpp"
#include "mechanics/material/parameters.hpp"
#include "results/store/material_file.hpp"

namespace langer {

struct Ranking {
  std::vector<RankedNumber> numbers;
  std::vector<std::string> keys;  // of the same numbers in the material
};

// Throws Failure(config) with everything that is wrong: a number that the material lacks, no
// bounds, bounds the law forbids.
Ranking ranking(const SensitivityConfig& config, Material& material,
                const std::optional<FitRecord>& fit,
                const std::function<Place(const std::string&)>& where);

}  // namespace langer
