// material.h5: a material, and where it comes from a fit the record of that fit. docs/schema.md
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/tensor/types.hpp"
#include "mechanics/material/material.hpp"
#include "mechanics/material/raised_stiffness.hpp"
#include "mechanics/material/ties.hpp"
#include "results/store/identity.hpp"
#include "results/store/study_record.hpp"

namespace langer {

struct FittedParameter {
  std::string name;  // a1, c1, ...; unique
  std::string unit;
  double value = 0;
  double lower = 0, upper = 0;  // bounds; may be infinite
  double standard_error = 0;    // NaN where the curve does not determine it
  double truth =
      std::numeric_limits<double>::quiet_NaN();  // of synthetic data; NaN where nobody knows
  double factor = 1.959963984540054;             // standard errors to each end of a 95 % interval
  std::string key = "";                          // its path in the config
  // a 95 % interval that a bound of this or of another parameter cuts (study/within_bounds.hpp);
  // NaN: by standard error and factor
  double low = std::numeric_limits<double>::quiet_NaN(),
         high = std::numeric_limits<double>::quiet_NaN();
};
std::array<double, 2> interval_95(const FittedParameter& parameter);  // NaN where it is not known

// One of the tests of a fit. n points; x and z are the axes of the specimen.
struct FittedTest {
  std::string name, kind, measure;
  double fibre_angle_deg = 0, weight = 1;
  std::vector<double> first,
      second;  // stretch (simple shear: its amount) along x; stretch along z, biaxial tests only
  std::vector<double> stress_x, stress_z, model_x, model_z;  // [MPa]; z may be empty
  double r2 = 0, mean_error_percent = 0, max_error_percent = 0;
};

// A curve or a field that was measured in a scene, of n values; x is what the file gives them over,
// such as the travel of an indenter.
struct FittedCurve {
  std::string name, quantity, unit, x_name, x_unit;  // quantity: force, u_x, ...
  double standard_deviation = 0;
  std::vector<double> x, measured, model;
  std::vector<Vec3> places;  // of a field [mm]; else empty
  double r2 = 0, mean_error_percent = 0, max_error_percent = 0;
  double discretisation_percent =
      std::numeric_limits<double>::quiet_NaN();  // estimated, of the largest value; NaN: not
                                                 // estimated
};

// The noise of the tests under which the parameters have the largest likelihood
// (fit/noise_model.hpp).
struct NoiseRecord {
  std::string model = "white";  // white, proportional, autoregressive, both
  double correlation = 0;       // from one value of a curve to the next
  double share = 0;             // of the variance at the mean stress: what grows with the stress
  double limit = 0;             // largest correlation that the lengths of the curves allow
  bool at_limit = false, share_at_limit = false;
  double minus_two_log_likelihood = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::pair<std::string, double>> aicc = {};  // of each kind that was compared
};

// How the parameters were found. p parameters, n points of the curve, k starts.
struct FitRecord {
  std::vector<FittedParameter> parameters;
  MatX covariance;          // (p, p), products of the parameters' units
  double cost = 0;          // half the sum of squared residuals [MPa^2]
  double kkt_residual = 0;  // largest violation of the optimality conditions at the bounds
  double mean_error_percent = 0, max_error_percent = 0;  // of the largest measured stress
  MatX starts;  // (k, p + 1) parameters and cost reached from each start; may be empty
  double strain_min = 0, strain_max = 0;      // range of the curve that was fitted
  std::vector<double> strain, stress, model;  // (n) of the first test [-], [MPa], [MPa]
  std::vector<FittedTest> tests;              // all of them
  std::vector<FittedCurve> curves;            // of scenes
  double r2 = 0, aicc = 0, bic = 0;           // see fit/fit.hpp; NaN where there are too few points
  std::optional<StiffnessAtRest> at_rest;     // where its bound was raised
  // correlation of the residuals from value to value, and how many independent values they count
  // as; 0 in files without it
  double residual_correlation = 0, effective_values = 0;
  NoiseRecord noise;
  // root mean square error of tests that are predicted from the others, in percent of each one's
  // largest stress; NaN where it was not asked for
  double left_out_error_percent = std::numeric_limits<double>::quiet_NaN();
  std::vector<Tie> ties;  // numbers of the law that follow others
  StudyRecord study;      // read back: fitted range, verdict and safe radius
  MatX sets;  // (n, p) read back: sets of parameters of the study's bootstrap; empty without one
};

// cov_ij / (s_i s_j); NaN where a parameter is not determined or the fit leaves it no variance
// (exact data)
MatX correlation(const MatX& covariance);

struct MaterialFile {
  Material material;
  std::optional<FitRecord> fit;
  std::string content_id;
};

// /summary gets the parameters, mean_error, max_error, cost, kkt_residual, r2, aicc and bic of a
// fit
void write_material(const std::string& path, const Material& material,
                    const std::optional<FitRecord>& fit, const Identity& identity);
MaterialFile read_material(const std::string& path);

}  // namespace langer
