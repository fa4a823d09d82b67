// One uniaxial curve, fitted: the paper's task.                                       [A23] eqs 35-36
// A curve of one test along the fibre does not determine a fibre term: see the correlation.
#pragma once

#include "fit/curve.hpp"
#include "fit/fit.hpp"

namespace langer {

struct UniaxialFitOptions {
  Dilatation dilatation = Dilatation::incompressible;
  int starts = 20;
  unsigned seed = 1;
  LeastSquaresOptions least_squares;
};

struct UniaxialFit {
  Material material;  // the law with the parameters found
  LeastSquaresResult best;
  MatX covariance;            // NaN where the curve does not determine a parameter
  MatX starts;                // (k, p + 1) parameters and cost reached from each start; infinite cost where nothing was reached
  std::vector<double> model;  // (n) [MPa]
  double mean_error_percent = 0, max_error_percent = 0;  // |model - stress| over the largest |stress|
};

// as fit() in fit.hpp
UniaxialFit fit_uniaxial(const Curve& curve, const Material& law, const std::vector<FreeParameter>& free,
                         const UniaxialFitOptions& options = {});

// |model - stress| in percent of the largest |stress|: mean and maximum
struct CurveError {
  double mean_percent = 0, max_percent = 0;
};
CurveError curve_error(const std::vector<double>& model, const std::vector<double>& stress);

}  // namespace langer
