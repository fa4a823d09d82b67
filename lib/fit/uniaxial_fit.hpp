// Parameters of a law from a uniaxial curve: least squares on the stress.             [A23] eqs 35-36
//   min over p of  1/2 sum_i (sigma(strain_i; p) - stress_i)^2,  lower <= p <= upper
// The law is any Material; the stress is that of material/uniaxial.hpp (eq. 34 of [A23] is not usable as printed).
// The search starts at the given values and at seeded random places of the box; the lowest cost wins, the first of equals.
// Curves of one test along the fibre do not determine a fibre term: see the correlation.
#pragma once

#include "fit/curve.hpp"
#include "fit/least_squares.hpp"
#include "material/parameters.hpp"

namespace langer {

struct FreeParameter {
  std::string key;  // as in material/parameters.hpp
  double start = 0, lower = 0, upper = 0;
};

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

// Throws Failure(input) if the curve has fewer points than there are parameters or carries no stress.
// best.converged tells whether an optimum was found.
UniaxialFit fit_uniaxial(const Curve& curve, const Material& law, const std::vector<FreeParameter>& free,
                         const UniaxialFitOptions& options = {});

// |model - stress| in percent of the largest |stress|: mean and maximum
struct CurveError {
  double mean_percent = 0, max_percent = 0;
};
CurveError curve_error(const std::vector<double>& model, const std::vector<double>& stress);

}  // namespace langer
