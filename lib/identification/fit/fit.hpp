// Parameters of a law from one or several tests: least squares on the stress.         [A23] eqs
// 35-36
//   min over p of  1/2 sum_i w_i^2 (model_i(p) - stress_i)^2,  lower <= p <= upper
// The values stand in the order of the tests; within a test all x components, then all z
// components. An angle whose box holds 180 degrees is periodic: it has no bounds, and the result
// is given within the box. The search starts at the given values and at seeded random places of the
// box; the lowest cost wins, the first of equals. Everything here may run on several threads at
// once, each with its own problem or result.
// Where the noise of tests is not white (noise_model.hpp), parameters and noise are those of
// largest likelihood: the search begins at the least squares and alternates between both. A nested
// law or noise model never has a larger likelihood than the one that contains it.
#pragma once

#include <memory>

#include "identification/fit/noise_model.hpp"
#include "identification/fit/residual_noise.hpp"
#include "identification/fit/test_data.hpp"
#include "mechanics/material/parameters.hpp"
#include "mechanics/material/ties.hpp"

namespace langer {

struct FreeParameter {
  std::string key;  // as in material/parameters.hpp
  double start = 0, lower = 0, upper = 0;
  bool preset = false;  // its bound next to 0 is the preset's: what the tests justify may raise it
                        // (stiffness_at_rest.hpp)
  std::string name = "",
              unit =
                  "";  // of one that is no number of the law: of a scene, or of how it was measured
  bool is_material_number() const { return name.empty(); }
};

// Tests whose model this folder does not know, such as whole scenes: m values behind those of
// `tests`, each in a unit of its own. p are all free parameters of the problem, in their order.
struct FurtherTests {
  virtual ~FurtherTests() = default;
  virtual const VecX& measured() const = 0;
  virtual const VecX& weight() const = 0;                       // 1/standard deviation
  virtual const std::vector<Eigen::Index>& curves() const = 0;  // values of each measured curve
  virtual bool model(const VecX& p, VecX& values) = 0;          // false where there is none
  virtual bool slope(const VecX& p, MatX& J) = 0;  // (m, p) of the values, not weighted
};

struct FitProblem {
  Material law;
  std::vector<FreeParameter> free;
  std::vector<Test> tests;
  Dilatation dilatation = Dilatation::incompressible;  // compressible: held uniaxial tests only
  std::vector<Tie> ties = {};                          // resolved; of numbers that are not free
  std::shared_ptr<FurtherTests> further =
      {};  // their weights are believed in: errors are no smaller than these make them
  NoiseKind noise = NoiseKind::white;  // of the tests; with further tests white only
};

struct FitOptions {
  int starts = 20;
  unsigned seed = 1;
  LeastSquaresOptions least_squares;
};

// How well a law describes the tests. Errors are |model - stress| in percent of the largest
// |stress| of the test; NaN for a test without stress, which those of all tests leave out.
//   r2 = 1 - sum (model - stress)^2 / sum (stress - mean stress)^2, NaN where every stress is the same
//   aicc = -2 ln L + 2 k + 2 k (k + 1)/(N - k - 1),  bic = -2 ln L + k ln N
// L is the likelihood of the noise model at its maximum over parameters and noise, but for a
// constant of the data: -2 ln L = N ln(2 cost/N) where the noise is white. N is the number of
// values; k counts parameters, the deviation and the numbers of the noise model.
struct FitQuality {
  double r2 = 0, aicc = 0, bic = 0, mean_error_percent = 0, max_error_percent = 0;
};

// What a noise model makes of the tests, for the choice among them.
struct NoiseCandidate {
  NoiseModel noise;
  double minus_two_log_likelihood = 0, aicc = 0;
};

struct FitResult {
  Material material;        // the law with the parameters found
  LeastSquaresResult best;  // its residuals are those of likelihood_problem()
  VecX residual;            // weight (model - measured), whatever the noise
  NoiseModel noise_model;
  std::vector<NoiseCandidate> noise_candidates;  // those that were compared; white first
  MatX covariance;  // under `noise`; NaN where the tests do not determine a parameter, and for
                    // those left out
  ResidualNoise noise;
  std::vector<bool> symmetric;  // angles of symmetry (periodic.hpp): no first effect
  std::vector<bool> left_out;   // of the covariance: those, and parameters on a bound
  MatX columns;                 // Jacobian, with the second derivative of angles of symmetry
  MatX starts;   // (k, p + 1) parameters and cost reached from each start; infinite cost where
                 // nothing was reached
  VecX model;    // of each value [MPa]; empty if no start has a model
  VecX further;  // of the further tests
  FitQuality quality;
  std::vector<FitQuality>
      of_test;  // r2 and errors; behind those of tests a curve of the further ones each
};

// stresses of a law in the states of a test [MPa], in the order above; false where a state does not
// exist
bool model_stress(const Material& material, const Test& test, Dilatation dilatation,
                  double* stress);

VecX measured_stress(const std::vector<Test>& tests);
std::vector<Eigen::Index> curve_sizes(
    const FitProblem& problem);  // values of each measured curve, in the order above
VecX weights(const std::vector<Test>& tests);

// residuals of all values to residuals that are alike and independent under a noise model
Standardizer standardizer(const FitProblem& problem, const NoiseModel& noise);

// the law with the numbers p in place of the free ones
Material with_parameters(const FitProblem& problem, const VecX& p);

// The problem in numbers. It holds copies of everything, but works in them: one copy per thread.
LeastSquares least_squares_problem(const FitProblem& problem);

// The same under the noise that a fit found: its least squares are the parameters of that fit.
LeastSquares likelihood_problem(const FitProblem& problem, const FitResult& fit);

// one search, from given values
LeastSquaresResult fit_from(const FitProblem& problem, const VecX& start,
                            const LeastSquaresOptions& options = {});

// Throws Failure(input) if there are fewer values than parameters, or no stress.
// best.converged: whether an optimum was found.
FitResult fit(const FitProblem& problem, const FitOptions& options = {});

}  // namespace langer
