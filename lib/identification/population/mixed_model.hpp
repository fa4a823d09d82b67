// Parameters of a population from tests of many specimens: a nonlinear model with mixed effects.
//
// Every specimen i has numbers phi_i of its own, which scatter about those of the population:
//   y_i = f_i(phi_i) + e_i,    phi_i = A_i beta + b_i,    b_i ~ N(0, Omega),    e_i ~ N(0, sigma^2)
// beta: population and effects of covariates. A specimen that says little about a number is drawn
// towards the population in it, one that says much keeps its own.
//
// Estimates are those of Lindstrom and Bates [LB90], as of nlme in R: with the modes b_i for given
// (beta, Omega, sigma) the model is made linear there, whose likelihood has a closed form; both
// steps are repeated until nothing changes. The likelihood is that of FOCE.
//   1. b_i = argmin |u_i(A_i beta + b)|^2 / sigma^2 + b^T Omega^-1 b            (Levenberg-Marquardt)
//   2. u ~ u_i + J_i (phi - phi_i): (beta, Omega, sigma) of largest likelihood  (Fisher's scoring)
// Omega = L L^T, so that a number that does not vary ends as a row of zeros, not as a failure.
//   q numbers of a specimen, k numbers in beta, r of the q vary; L (r, r) lower triangular
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/tensor/types.hpp"
#include "identification/statistics/posterior_config.hpp"

namespace langer {

// The data of one specimen near phi: residuals u (model less measured, each with the same
// deviation sigma) and their slope (m, q). False where the model has no state.
struct MixedSpecimen {
  std::function<bool(const VecX& phi, VecX& u, MatX* slope)> residual;
  MatX design;  // A (q, k)
};

struct MixedOptions {
  std::vector<bool> varies;  // (q) between specimens; empty: all
  bool full = true;          // Omega with correlations; otherwise diagonal
  // (q) deviation between specimens beyond which a number counts as not known; empty: none
  VecX largest_deviation = {};
  int threads = 1;
  int rounds = 60;
  double tolerance = 1e-7;  // change of beta in standard errors, and relative change of Omega
  // called at the modes of each round: residuals may change their weights there
  std::function<void(const std::vector<VecX>& phi)> reweigh = {};
};

// Where the estimation begins and ends.
struct MixedState {
  VecX beta;
  MatX omega;  // (q, q), zero in rows of numbers that do not vary
  double sigma = 1;
  std::vector<VecX> b;  // (q) of each specimen
};

struct MixedResult : MixedState {
  bool converged = false;
  std::string why;
  std::vector<Eigen::Index> unlimited;  // numbers whose deviation reached the largest
  int rounds = 0;
  double minus_two_log_likelihood = 0;  // of all values, with its constants
  MatX beta_covariance;                 // (k, k)
  // Of the logarithm of each standard deviation, and of artanh of each correlation: standard
  // errors from Fisher's information. NaN where a number does not vary.
  VecX log_deviation_error;     // (q)
  MatX correlation_error;       // (q, q)
  std::vector<MatX> explained;  // (q, q) covariance of the modes b_i of each specimen
  int values = 0;
  int likelihood_parameters = 0;  // in beta, Omega and sigma
};

MixedResult fit_mixed_model(const std::vector<MixedSpecimen>& specimens, const MixedState& start,
                            const MixedOptions& options);

// The posterior of beta, Omega and sigma of the model that is linear at the modes of an estimate.
// The specimens' own numbers are integrated in closed form, and so is beta: the sampler moves in
// the entries of L and in ln sigma alone, and each sample of beta is drawn from its normal
// distribution given those. Priors are flat in beta, in the deviations between specimens, in the
// directions of the rows of L (all correlations of two numbers alike) and in ln sigma.
struct MixedDraws {
  MatX beta;        // (samples, k)
  MatX deviations;  // (samples, q) between specimens, 0 of numbers that do not vary
  VecX sigma, log_density;
  int chains = 0, divergences = 0;
  double acceptance = 0;
};
MixedDraws mixed_posterior(const std::vector<MixedSpecimen>& specimens, const MixedResult& estimate,
                           const MixedOptions& options, const PosteriorConfig& config, int threads);

}  // namespace langer
