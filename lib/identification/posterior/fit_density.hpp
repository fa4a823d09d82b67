// The posterior of a fit as a function of numbers x in which a sampler moves well. A parameter with
// two bounds is the logit of its place between them, one with one bound the logarithm of its
// distance from it, the others are themselves. A parameter whose bound is probable is itself, too,
// and its bounds are walls: near a bound the logit would go to infinity.
#pragma once

#include <vector>

#include "identification/fit/fit.hpp"

namespace langer {

// One parameter as a number x.
struct FreeNumber {
  double lower = 0, upper = 0;
  bool below = false, above = false;  // which bounds there are
  bool walls = false;                 // x is the parameter, between walls

  double number(double x) const;     // the parameter
  double slope(double x) const;      // d parameter / dx
  double curvature(double x) const;  // d ln slope / dx
  double place(double p) const;      // x of a parameter
};

// One for each thread: the problem works in its own copies.
class FitDensity {
 public:
  FitDensity(const FitProblem& problem, const FitResult& fit);

  VecX numbers(const VecX& x) const;  // (p) parameters
  VecX place(const VecX& p) const;    // (p) x of parameters
  // (p) walls of x, infinite where there is none
  VecX lower_walls() const;
  VecX upper_walls() const;
  // Moves angles by whole periods to where the estimate is.
  void turn_to_estimate(VecX& p) const;

  // ln of the density at x but for a constant, and its gradient (p); -infinity where there is none
  double operator()(const VecX& x, VecX& gradient);
  // ln of the density of the parameters p themselves, which no choice of x changes; likewise
  double of_parameters(const VecX& p);
  double log_slope(const VecX& x) const;  // ln |dp/dx|: the density at x is that of p times |dp/dx|
  VecX between_walls(const VecX& x) const;  // moved to the nearest place that walls allow
  // The covariance of x by the curvature of the density at x.
  MatX scale(const VecX& x);

 private:
  double of_residual(const VecX& u) const;
  void set_walls();
  bool curvature_of_tests(const VecX& p, MatX& H);

  LeastSquares model_;
  VecX estimate_;
  std::vector<FreeNumber> free_;
  bool known_noise_ = false;
};

}  // namespace langer
