// How probable which parameters are, after a fit: samples of the posterior.
//
// Where a model is not straight over the uncertainty of its parameters, an estimate and its
// standard errors say too little: the posterior has a shape. Its density is that of the likelihood
// of the fit (under its noise model, the deviation of the noise integrated over 1/sigma), times the
// priors, over the box of the parameters:
//   p(theta) ~ |u(theta)|^-N prior(theta)        exp(-|u|^2/2) prior(theta) where weights are believed in
// For a straight model and no prior this is Student's distribution, whose quantiles are the
// intervals of the profile.
// On which scale it is sampled: fit_density.hpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "identification/fit/fit.hpp"
#include "identification/statistics/posterior_config.hpp"
#include "results/store/record_table.hpp"

namespace langer {

struct Posterior {
  std::vector<std::string> names;
  MatX samples;  // (samples, p), chain after chain
  VecX log_density;
  int chains = 0, divergences = 0;
  double acceptance = 0;
  std::vector<double> r_hat, effective;  // (p)
  RecordTable table;                     // posterior: parameter, mean, ..., quantiles
};

// threads: of the chains, on which the samples do not depend
Posterior posterior(const FitProblem& problem, const FitResult& fit, const PosteriorConfig& config,
                    int threads, const std::function<void(double)>& progress = {});

// R-hat, effective samples and the table of samples that are there: chain after chain.
void summarise(Posterior& posterior);

std::string posterior_csv(const Posterior& posterior);  // chain, parameters, log_density
std::vector<std::string> posterior_lines(const Posterior& posterior);
// advice: what makes it better known
std::vector<std::string> posterior_warnings(
    const Posterior& posterior,
    const std::string& advice = "more samples, more warmup, or parameters that the tests know");

}  // namespace langer
