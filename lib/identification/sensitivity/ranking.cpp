#include "identification/sensitivity/ranking.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/text.hpp"
#include "core/config/member.hpp"

namespace langer {

Ranking ranking(const SensitivityConfig& config, Material& material,
                const std::optional<FitRecord>& fit,
                const std::function<Place(const std::string&)>& where) {
  const std::vector<MaterialParameter> known = parameters(material);
  // Without a list of parameters those of the fit are ranked.
  std::vector<RankedParameter> asked = config.parameters;
  if (asked.empty() && fit)
    for (const FittedParameter& p : fit->parameters)
      for (const MaterialParameter& k : known)
        if (k.name == p.name) asked.push_back({k.key, {}, {}, {}});
  std::vector<Error> errors;
  const auto say = [&](const std::string& key, std::string found, std::string expected,
                       std::string hint = "") {
    errors.push_back({where(key), key, std::move(found), std::move(expected), std::move(hint)});
  };
  if (asked.empty())
    say("parameters", "none, and the material was not fitted", "numbers to rank, with bounds");

  Ranking ranking;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const RankedParameter& p = asked[i];
    const std::string at = fmt::format("parameters[{}]", i);
    const auto one =
        std::find_if(known.begin(), known.end(), [&](const auto& k) { return k.key == p.key; });
    if (one == known.end()) {
      std::vector<std::string> keys;
      for (const MaterialParameter& k : known) keys.push_back(k.key);
      const std::string near = nearest(p.key, keys);
      say(at + ".key", "the material has no number \"" + p.key + "\"", "one of " + list_words(keys),
          did_you_mean(near));
      continue;
    }
    RankedNumber n{one->name, one->unit, *one->value, 0, 0};
    const auto fitted = [&]() -> const FittedParameter* {
      if (fit)
        for (const FittedParameter& f : fit->parameters)
          if (f.name == n.name) return &f;
      return nullptr;
    }();
    // Bounds in order of preference: given ones, a fraction of the value, those of the fit.
    if (p.lower) {
      n.lower = *p.lower;
      n.upper = *p.upper;
    } else if (p.around) {
      n.lower = n.value - *p.around * std::abs(n.value);
      n.upper = n.value + *p.around * std::abs(n.value);
    } else if (fitted) {
      n.lower = fitted->lower;
      n.upper = fitted->upper;
    } else
      say(at, p.key + " has no bounds, and it was not fitted", "lower and upper, or around");
    if ((p.lower || p.around || fitted) && !(n.lower < n.upper))
      say(at, fmt::format("{} = {} gives an empty range", p.key, n.value), "lower < upper");
    if (n.lower < one->range.low || n.upper > one->range.high)
      say(at, fmt::format("bounds {} and {}", n.lower, n.upper),
          fmt::format("within {} and {}, as the material model requires", one->range.low,
                      one->range.high));
    ranking.numbers.push_back(n);
    ranking.keys.push_back(one->key);
  }
  if (!errors.empty()) throw Failure(Exit::config, std::move(errors));
  return ranking;
}

}  // namespace langer
