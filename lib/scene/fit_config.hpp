// What the fit stage's YAML may say.
//   data:       {file: ../../data/curve.csv, strain_to: 0.6}
//   law:        a material; its numbers are the start values, those not named under `parameters` stay as they are
//   parameters: [{key: matrix.yeoh.a1, lower: -10, upper: 10}, ...]
#pragma once

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/input_path.hpp"
#include "config/writer.hpp"
#include "fit/uniaxial_fit.hpp"

namespace langer {

struct FitData {
  InputPath file;
  std::optional<double> strain_from, strain_to;
  static void fields(auto& v) {
    v(&FitData::file, "file", unit::none, "measured curve, CSV with units in the names of its columns", required);
    v(&FitData::strain_from, "strain_from", unit::none, "points below this strain are left out");
    v(&FitData::strain_to, "strain_to", unit::none, "points above this strain are left out");
  }
};

struct FitParameter {
  std::string key;
  double lower = 0, upper = 0;
  std::optional<double> start;
  static void fields(auto& v) {
    v(&FitParameter::key, "key", unit::none, "path of a number of the law, such as matrix.yeoh.a1", required);
    v(&FitParameter::lower, "lower", unit::none, "lower bound, in the unit of the number", required);
    v(&FitParameter::upper, "upper", unit::none, "upper bound", required);
    v(&FitParameter::start, "start", unit::none, "where the first search starts; by default the law's own value");
  }
};

struct FitConfig {
  FitData data;
  Material law;
  std::vector<FitParameter> parameters;
  Dilatation dilatation = Dilatation::incompressible;
  int starts = 20;
  int seed = 1;
  static void fields(auto& v) {
    v(&FitConfig::data, "data", unit::none, "the curve to fit", required);
    v(&FitConfig::law, "law", unit::none, "energy terms, fibre angles and the numbers that are not fitted", required);
    v(&FitConfig::parameters, "parameters", unit::none, "the numbers to find", required);
    v(&FitConfig::dilatation, "dilatation", unit::none,
      "state of the specimen: the volume term left out (incompressible) or counted");
    v(&FitConfig::starts, "starts", unit::none, "searches: one from the start values, the others from random places in the box",
      between(1, 100000));
    v(&FitConfig::seed, "seed", unit::none, "of the random places", at_least(0));
  }
  std::vector<Complaint> complaints() const;
};

// the parameters with their start values; a key that the law lacks stays without (complaints() names it)
inline std::vector<FreeParameter> free_parameters(const FitConfig& config) {
  Material law = config.law;
  std::vector<FreeParameter> free;
  for (const FitParameter& p : config.parameters) {
    FreeParameter one{p.key, p.start.value_or(0), p.lower, p.upper};
    for (const MaterialParameter& known : parameters(law))
      if (known.key == p.key && !p.start) one.start = *known.value;
    free.push_back(one);
  }
  return free;
}

inline std::vector<Complaint> FitConfig::complaints() const {
  std::vector<Complaint> all;
  if (parameters.empty()) all.push_back({"parameters", "an empty list", "one number to find at least", ""});
  if (data.strain_from && data.strain_to && *data.strain_from >= *data.strain_to)
    all.push_back({"data.strain_to", "found " + number_text(*data.strain_to),
                   "more than strain_from, " + number_text(*data.strain_from), ""});
  Material copy = law;
  const std::vector<MaterialParameter> known = langer::parameters(copy);
  std::vector<std::string> keys;
  for (const MaterialParameter& k : known) keys.push_back(k.key);
  const std::vector<FreeParameter> free = free_parameters(*this);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const FitParameter& p = parameters[i];
    const std::string at = "parameters[" + std::to_string(i) + "].";
    const auto found = std::find(keys.begin(), keys.end(), p.key);
    if (found == keys.end()) {
      std::string list;
      for (const std::string& k : keys) list += (list.empty() ? "" : ", ") + k;
      const std::string near = nearest(p.key, keys);
      all.push_back({at + "key", "the law has no number \"" + p.key + "\"", "one of " + list,
                     near.empty() ? "" : "did you mean \"" + near + "\"?"});
      continue;
    }
    if (!seen.insert(p.key).second) all.push_back({at + "key", "\"" + p.key + "\" a second time", "each number once", ""});
    const Range& range = known[static_cast<std::size_t>(found - keys.begin())].range;
    if (!(p.lower < p.upper)) {
      all.push_back({at + "upper", "found " + number_text(p.upper), "more than lower, " + number_text(p.lower), ""});
      continue;
    }
    if (p.lower < range.low || (p.lower == range.low && !range.low_included))
      all.push_back(
          {at + "lower", "found " + number_text(p.lower),
           std::string("a number ") + (range.low_included ? ">= " : "> ") + number_text(range.low) + ", as the law asks", ""});
    if (p.upper > range.high)
      all.push_back(
          {at + "upper", "found " + number_text(p.upper), "a number <= " + number_text(range.high) + ", as the law asks", ""});
    if (free[i].start < p.lower || free[i].start > p.upper)
      all.push_back({at + (p.start ? "start" : "key"), "starts at " + number_text(free[i].start),
                     "a value between " + number_text(p.lower) + " and " + number_text(p.upper),
                     p.start ? "" : "the start is the law's own value unless `start` is given"});
  }
  return all;
}

}  // namespace langer
