// What is known of a parameter before a fit: the key `prior` of an item of `parameters`.
//   prior: {normal: [2.0, 0.1]}        mean and standard deviation, in the unit of the number
//   prior: {lognormal: [0.3, 0.2]}     median, and standard deviation of the logarithm
//   prior: {file: population.h5}       scatter between the specimens of a population, or estimate
//                                      and standard error of an earlier fit
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/base/fields.hpp"
#include "core/base/input_path.hpp"

namespace langer {

struct PriorConfig {
  std::optional<std::array<double, 2>> normal, lognormal;
  InputPath file;
  static void fields(auto& v) {
    v(&PriorConfig::normal, "normal", unit::none, "mean and standard deviation");
    v(&PriorConfig::lognormal, "lognormal", unit::none,
      "median, and standard deviation of the logarithm");
    v(&PriorConfig::file, "file", unit::none,
      "material.h5 of a fit: its scatter between specimens, or its estimate and standard error");
  }
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> all;
    const int given = static_cast<int>(normal.has_value()) +
                      static_cast<int>(lognormal.has_value()) +
                      static_cast<int>(!file.path.empty());
    if (given != 1)
      all.push_back({"", "found " + std::to_string(given) + " of normal, lognormal, file",
                     "one of them", "prior: {normal: [2.0, 0.1]}"});
    if (normal && !((*normal)[1] > 0))
      all.push_back(
          {"normal", "a standard deviation that is not above 0", "[mean, deviation]", ""});
    if (lognormal && !((*lognormal)[0] > 0 && (*lognormal)[1] > 0))
      all.push_back({"lognormal", "a number that is not above 0",
                     "[median, standard deviation of the logarithm]", ""});
    return all;
  }
};

}  // namespace langer
