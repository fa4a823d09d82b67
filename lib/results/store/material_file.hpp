// material.h5: a material and, if it was fitted, the record of the fit. docs/schema.md
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
#include "results/store/population_record.hpp"
#include "results/store/record_table.hpp"
#include "results/store/study_record.hpp"

namespace langer {

// A fitted parameter with its bounds and its confidence interval.
struct FittedParameter {
  std::string name;  // a1, c1, ...; unique
  std::string unit;
  double value = 0;
  double lower = 0, upper = 0;                              // bounds; may be infinite
  double standard_error = 0;                                // NaN if the data do not determine it
  double truth = std::numeric_limits<double>::quiet_NaN();  // of synthetic data; otherwise NaN
  double factor = 1.959963984540054;  // standard errors to each end of a 95 % interval
  std::string key = "";               // its path in the config
  // The 95 % interval if a bound of this or of another parameter cuts it
  // (statistics/within_bounds.hpp). NaN: the interval follows from standard error and factor.
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
};
// The ends of the 95 % interval; NaN if it is not known.
std::array<double, 2> interval_95(const FittedParameter& parameter);

// One of the tests of a fit, with n points. x and z are the axes of the specimen.
struct FittedTest {
  std::string name, kind, measure;
  double fibre_angle_deg = 0, weight = 1;
  std::vector<double> first;   // stretch along x; in simple shear its amount
  std::vector<double> second;  // stretch along z, in biaxial tests only
  std::vector<double> stress_x, stress_z, model_x, model_z;  // [MPa]; z may be empty
  double r2 = 0, mean_error_percent = 0, max_error_percent = 0;
};

// A curve or a field that was measured in a scene, with n values. x is the column of the file
// over which they are given, such as the travel of an indenter.
struct FittedCurve {
  std::string name, quantity, unit, x_name, x_unit;  // quantity: force, u_x, ...
  double standard_deviation = 0;
  std::vector<double> x, measured, model;
  std::vector<Vec3> places;  // of a field [mm]; else empty
  double r2 = 0, mean_error_percent = 0, max_error_percent = 0;
  // Estimated discretisation error relative to the largest value; NaN if it was not estimated.
  double discretisation_percent = std::numeric_limits<double>::quiet_NaN();
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

// How the parameters were found: p parameters, n points of the curve, k starts.
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
  double r2 = 0, aicc = 0, bic = 0;           // see fit/fit.hpp; NaN if there are too few points
  std::optional<StiffnessAtRest> at_rest;     // if its bound was raised
  // The correlation of the residuals from value to value, and the number of independent values that
  // they count as; 0 in files without it.
  double residual_correlation = 0, effective_values = 0;
  NoiseRecord noise;
  // Root mean square error of tests that are predicted from the others, in percent of the largest
  // stress of each; NaN if it was not asked for.
  double left_out_error_percent = std::numeric_limits<double>::quiet_NaN();
  std::vector<Tie> ties;  // parameters of the material that follow others
  StudyRecord study;      // as read: fitted range, verdict and safe radius
  MatX sets;              // (n, p) as read: parameters of the study's bootstrap; empty without it
  std::vector<RecordTable> tables;             // of comparisons, populations and posteriors
  std::optional<PopulationRecord> population;  // of a fit to many specimens
};

// cov_ij / (s_i s_j); NaN if a parameter is not determined or has no variance (exact data).
MatX correlation(const MatX& covariance);

// The contents of material.h5.
struct MaterialFile {
  Material material;
  std::optional<FitRecord> fit;
  std::string content_id;
};

// Writes the file. /summary gets the parameters, mean_error, max_error, cost, kkt_residual, r2,
// aicc and bic of a fit.
void write_material(const std::string& path, const Material& material,
                    const std::optional<FitRecord>& fit, const Identity& identity);
MaterialFile read_material(const std::string& path);

}  // namespace langer
