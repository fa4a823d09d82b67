// The posterior of a fit whose tests are costly: each model is a run of scenes.
//
// Scenes are run at some hundred sets of parameters. Polynomials of their values are sampled in
// their place (polynomial_tests.hpp); runs at some of the samples then show how wrong these are:
//   w_i = density of the scenes / density of the polynomials at sample i
//   shift = standard deviation of w / mean of w
// By Cauchy and Schwarz no mean over the samples differs by more than `shift` of its parameter's
// standard deviations from that of the scenes. While it differs by more than was asked, these runs
// become part of the next polynomial.
// Where more runs do not help, as where nodes begin to slip and the model has kinks, the samples of
// the polynomials are proposals: each is run, and accepted by Metropolis' rule. What remains are
// samples of the scenes themselves, one for each run.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "identification/posterior/polynomial_tests.hpp"
#include "identification/posterior/posterior.hpp"

namespace langer {

struct CostlyTests {
  std::shared_ptr<FurtherTests> tests;
  // makes the runs of many sets of parameters, side by side where there are threads; may be empty
  std::function<void(const std::vector<VecX>& p)> run_ahead;
  // the problem of the fit with other tests in place of the costly ones, its priors as before
  std::function<FitProblem(const std::shared_ptr<FurtherTests>& others)> problem_with;
};

struct CostlyPosterior {
  Posterior posterior;
  int runs = 0;         // sets of parameters at which there was a run, checks included
  int without = 0;      // of these: without an end
  int degree = 0;       // of the polynomials
  int checks = 0;       // samples at which they were checked
  double shift = 0;     // of the last check
  bool reached = true;  // the shift that was asked for
  int proposals = 0;    // runs at samples that were proposed; 0: the samples are of polynomials
  double accepted = 0;  // share of them
  std::shared_ptr<PolynomialTests> polynomials;  // what was sampled, or made the proposals
};

// Throws Failure(not_converged) where too few runs have an end. say: a line for each polynomial;
// progress: the share of the proposals that were run.
CostlyPosterior costly_posterior(const CostlyTests& costly, const FitResult& fit,
                                 const PosteriorConfig& config, int threads,
                                 const std::function<void(const std::string&)>& say = {},
                                 const std::function<void(double)>& progress = {});

std::vector<std::string> costly_posterior_lines(const CostlyPosterior& sampled);
std::vector<std::string> costly_posterior_warnings(const CostlyPosterior& sampled,
                                                   const PosteriorConfig& config);

}  // namespace langer
