#include "identification/setup/priors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "results/store/material_file.hpp"

namespace langer {

namespace {

// What a file knows of a parameter; false: nothing.
bool read_prior(const MaterialFile& file, const std::string& key, Prior& prior) {
  if (!file.fit) return false;
  if (const auto& population = file.fit->population) {
    const auto found = std::ranges::find(population->keys, key);
    if (found == population->keys.end()) return false;
    const auto at = static_cast<std::size_t>(found - population->keys.begin());
    const auto j = static_cast<Eigen::Index>(at);
    const double variance = population->scatter(j, j) + population->median_covariance(j, j);
    if (!(variance > 0)) return false;
    prior.centre = population->median[j];
    prior.deviation = std::sqrt(variance);
    const std::string& link = population->links[at];
    prior.logarithm = link == "log";
    if (link != "logit") return true;
    // to first order on the scale of the number itself
    const double width = population->upper[at] - population->lower[at];
    const double share = 1 / (1 + std::exp(-prior.centre));
    prior.centre = population->lower[at] + width * share;
    prior.deviation *= width * share * (1 - share);
    return true;
  }
  const auto found = std::ranges::find(file.fit->parameters, key, &FittedParameter::key);
  if (found == file.fit->parameters.end() || !(found->standard_error > 0)) return false;
  prior.centre = found->value;
  prior.deviation = found->standard_error;
  return true;
}

}  // namespace

std::vector<Prior> priors_of(const FitConfig& config, const FitProblem& problem,
                             const std::function<Place(const std::string&)>& at) {
  std::vector<Prior> priors;
  for (std::size_t i = 0; i < config.parameters.size(); ++i) {
    const auto& asked = config.parameters[i].prior;
    if (!asked) continue;
    Prior prior;
    prior.number = static_cast<Eigen::Index>(i);
    const std::string& key = problem.free[i].key;
    const std::string place = fmt::format("parameters[{}].prior", i);
    if (asked->normal) {
      prior.centre = (*asked->normal)[0];
      prior.deviation = (*asked->normal)[1];
    } else if (asked->lognormal) {
      prior.logarithm = true;
      prior.centre = std::log((*asked->lognormal)[0]);
      prior.deviation = (*asked->lognormal)[1];
    } else if (!read_prior(read_material(asked->file.path), key, prior)) {
      throw Failure(
          Exit::config,
          Error{at(place), place, fmt::format("{} says nothing of {}", asked->file.path, key),
                "material.h5 of a fit with this parameter and its standard error, or of a "
                "population",
                ""});
    }
    priors.push_back(prior);
  }
  return priors;
}

}  // namespace langer
