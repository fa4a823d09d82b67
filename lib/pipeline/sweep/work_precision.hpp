// Accuracy against cost over the levels of a refinement study (work-precision diagram): errors
// against a reference, the Pareto front of levels that no other level beats in both error and time,
// and the cheapest level below a wanted error.
//   error      |value - reference| / |reference|, one column per quantity. An error below the
//              uncertainty of the reference is not known: it counts as large as that uncertainty.
//   reference  a member of the study; or the limit f of f + A h^p for the mesh size h = 0, fitted to
//              members with a given p; or the limit of three members whose mesh sizes have a
//              constant ratio r (Richardson's extrapolation [R11]):
//                p = log((f1 - f2) / (f2 - f3)) / log r,   f = f3 + (f3 - f2) / (r^p - 1)
//              If the differences do not shrink with one sign there is no such limit, and the value
//              of the finest mesh is used.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace langer {

// A limit for vanishing mesh size, with its uncertainty.
struct Limit {
  double value = 0;
  double order = 0;        // p; 0 if the finest value is used as the limit
  double uncertainty = 0;  // |limit - finest|, or the last difference if there is no limit
};
// The limit by least squares; its uncertainty is the standard error of f. At least three lengths,
// not all the same.
Limit fitted_limit(const std::vector<double>& lengths, const std::vector<double>& values,
                   double order);
Limit richardson(double coarse, double middle, double fine, double ratio);

// The error, or the uncertainty of the reference if the error is smaller. NaN stays NaN.
inline double known_error(double error, double uncertainty) {
  if (std::isless(error, uncertainty)) return uncertainty;
  return error;
}

// The Pareto front: indices by rising cost, each with a smaller error (by more than rounding) than
// all before it. Levels whose cost or error is not finite are left out.
std::vector<int> pareto_front(const std::vector<double>& cost, const std::vector<double>& error);

// The level of least cost with an error of at most `wanted`; -1 if there is none.
int cheapest(const std::vector<double>& cost, const std::vector<double>& error, double wanted);

}  // namespace langer
