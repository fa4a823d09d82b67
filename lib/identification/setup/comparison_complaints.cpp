#include "identification/setup/comparison_complaints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/base/text.hpp"
#include "core/config/writer.hpp"
#include "identification/setup/law_catalogue.hpp"

namespace langer {

std::vector<Complaint> DiscoverConfig::complaints() const {
  std::vector<Complaint> all;
  const std::vector<std::string> known = term_names();
  std::set<std::string> seen;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const std::string at = fmt::format("terms[{}]", i);
    if (std::find(known.begin(), known.end(), terms[i]) == known.end())
      all.push_back({at, "found \"" + terms[i] + "\"",
                     fmt::format("one of {}", fmt::join(known, ", ")),
                     did_you_mean(nearest(terms[i], known))});
    if (!seen.insert(terms[i]).second)
      all.push_back({at, "\"" + terms[i] + "\" a second time", "each term once", ""});
  }
  return all;
}

std::vector<Complaint> SpecimensConfig::complaints() const {
  std::vector<Complaint> all;
  const bool one_file = data.find('{') == std::string::npos;
  if (one_file && where.empty())
    all.push_back({"data", "one file of all specimens, without `where`",
                   "{id} in the path, or where: {column: \"{id}\"}",
                   "data: \"curves/{id}_{test}.csv\""});
  return all;
}

namespace {

std::string text_of(const Material& law) { return to_text(to_tree(law)); }

void complain_of_laws(const FitConfig& config, std::vector<Complaint>& all) {
  const std::vector<std::string> known = catalogue_names();
  std::set<std::string> seen;
  for (std::size_t i = 0; i < config.laws.size(); ++i) {
    const std::string& name = config.laws[i];
    const std::string at = fmt::format("laws[{}]", i);
    if (std::find(known.begin(), known.end(), name) == known.end())
      all.push_back({at, "found \"" + name + "\"", fmt::format("one of {}", fmt::join(known, ", ")),
                     did_you_mean(nearest(name, known))});
    if (!seen.insert(name).second)
      all.push_back({at, "\"" + name + "\" a second time", "each law once", ""});
  }
  const auto first = catalogue_law(config.laws.front());
  if (first && text_of(first->law) != text_of(config.law))
    all.push_back({"law", "found together with laws", "one of the two",
                   "the names in `laws` stand for whole laws with their parameters"});
}

// keys that a fit of several laws, or of many specimens, does not have
void complain_of_other_keys(const FitConfig& config, const std::string& key,
                            std::vector<Complaint>& all) {
  const auto complain = [&](bool found, const std::string& other, const std::string& hint) {
    if (found) all.push_back({other, "found together with " + key, "one of the two", hint});
  };
  complain(config.has_scenes(), "data", "tests that are scenes are fitted with one law");
  complain(config.cross_check != SecondAnswer::none, "cross_check",
           "check the law that is chosen in a fit of its own");
  if (key == "specimens") {
    complain(config.leave_one_out, "leave_one_out", "");
    complain(config.study.has_value() && !config.study->posterior, "study",
             "intervals are part of the fit of a population; study: {posterior: {}} is possible");
  }
  for (std::size_t i = 0; i < config.parameters.size(); ++i)
    complain(config.parameters[i].prior.has_value(), fmt::format("parameters[{}].prior", i), "");
}

// A prior has a weight beside the tests, whose noise is then known and white.
void complain_of_priors(const FitConfig& config, std::vector<Complaint>& all) {
  bool any = false;
  for (std::size_t i = 0; i < config.parameters.size(); ++i) {
    const auto& prior = config.parameters[i].prior;
    if (!prior) continue;
    any = true;
    const auto& lower = config.parameters[i].lower;
    if (prior->lognormal && lower && *lower < 0)
      all.push_back({fmt::format("parameters[{}].prior.lognormal", i),
                     "found for a number that may be negative", "lower: 0 or more", ""});
  }
  if (!any) return;
  const NoiseKind noise = config.noise_model;
  if (noise != NoiseKind::automatic && noise != NoiseKind::white)
    all.push_back({"noise",
                   std::string("found ") + names(noise)[static_cast<std::size_t>(noise)] +
                       " together with a prior",
                   "auto or white", "a prior counts against noise of a known deviation"});
  if (config.leave_one_out)
    all.push_back({"leave_one_out", "true, together with a prior", "false", ""});
}

void complain_of_specimens(const FitConfig& config, std::vector<Complaint>& all) {
  const SpecimensConfig& specimens = *config.specimens;
  std::vector<std::string> keys;
  for (const FitParameter& p : config.parameters) keys.push_back(p.key);
  const auto check = [&](const std::string& at, const std::string& key) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) return;
    all.push_back({at, "found \"" + key + "\"",
                   fmt::format("one of the parameters: {}", fmt::join(keys, ", ")),
                   did_you_mean(nearest(key, keys))});
  };
  for (std::size_t i = 0; i < specimens.shared.size(); ++i)
    check(fmt::format("specimens.shared[{}]", i), specimens.shared[i]);
  for (std::size_t i = 0; i < specimens.covariates.size(); ++i)
    for (std::size_t j = 0; j < specimens.covariates[i].on.size(); ++j)
      check(fmt::format("specimens.covariates[{}].on[{}]", i, j), specimens.covariates[i].on[j]);
  if (!keys.empty() && specimens.shared.size() >= keys.size())
    all.push_back({"specimens.shared", "all parameters", "one at least that varies",
                   "tests of one population without scatter are one fit of all data"});
}

}  // namespace

std::vector<Complaint> comparison_complaints(const FitConfig& config) {
  std::vector<Complaint> all;
  const auto both = [&](const std::string& one, const std::string& other) {
    all.push_back({other, "found together with " + one, "one of the two", ""});
  };
  const bool laws = !config.laws.empty();
  const bool discover = config.discover.has_value();
  const bool specimens = config.specimens.has_value();
  if (laws && discover) both("laws", "discover");
  if (laws && specimens) both("laws", "specimens");
  if (discover && specimens) both("discover", "specimens");
  if (!all.empty()) return all;
  if (laws) {
    complain_of_laws(config, all);
    complain_of_other_keys(config, "laws", all);
  }
  if (discover) complain_of_other_keys(config, "discover", all);
  if (specimens) {
    complain_of_specimens(config, all);
    complain_of_other_keys(config, "specimens", all);
  }
  complain_of_priors(config, all);
  for (std::size_t i = 0; i < config.data.size(); ++i)
    if (!config.data[i].specimen.empty() && !specimens)
      all.push_back({fmt::format("data[{}].specimen", i), "found without `specimens`",
                     "specimens: {table: specimens.csv, data: ...}", ""});
  return all;
}

}  // namespace langer
