// Accuracy against cost over the levels of a refinement study: errors against a reference, the
// front of levels that none beats in both, the cheapest level under a wanted error.
//   error      |value - reference| / |reference|; of the whole study's table one column per quantity. What is smaller than the
//              uncertainty of the reference is not known: it counts as large as that, and no level is told for less
//   reference  a member of the study; or what members with cells of lengths h leave at h = 0, fitted as f + A h^p with a given p; or
//              the limit that three members with cells in a constant ratio r point to:
//                p = log((f1 - f2) / (f2 - f3)) / log r,   f = f3 + (f3 - f2) / (r^p - 1)                       [R11]
//              where the differences do not shrink with one sign there is no such limit, and the finest stands for it
#pragma once

#include <string>
#include <vector>

namespace langer {

struct Limit {
  double value = 0;
  double order = 0;        // p; 0 where the finest value stands for the limit
  double uncertainty = 0;  // |limit - finest|, or the last difference where there is no limit
};
// least squares; uncertainty: the standard error of f. Lengths: at least three, not all the same
Limit fitted_limit(const std::vector<double>& lengths, const std::vector<double>& values,
                   double order);
Limit richardson(double coarse, double middle, double fine, double ratio);

// as large as the uncertainty of the reference, if smaller; no number stays none
inline double known_error(double error, double uncertainty) {
  return error < uncertainty ? uncertainty : error;
}

// Indices by rising cost, each with a smaller error (by more than rounding) than all before it.
// Levels that are not a number are left out.
std::vector<int> pareto_front(const std::vector<double>& cost, const std::vector<double>& error);

// Least cost with an error of at most `wanted`; -1: none.
int cheapest(const std::vector<double>& cost, const std::vector<double>& error, double wanted);

}  // namespace langer
