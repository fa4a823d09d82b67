// Intervals and second moments of a fit with parameters on a bound.
//
// An estimate on its bound is not known exactly: the true value may be anywhere inside that the
// data allow, and correlated parameters move with it. The usual covariance knows nothing of bounds.
// Here the model is linearised at the optimum, and the linear problem is solved in the box:
//   interval of p_i   all x with  min over the others of |r + J (p - p^)|^2 - |r|^2  <=  half_i^2 at p_i = x     (profile)
//   second moments    E (p - p^)(p - p^)^T of fits to fresh noise: p = argmin in the box of |J (p - q)|, q ~ N(p^, covariance of
//                     the fit without bounds)
// Without a bound in reach these are half_i times what the other data leave of the column, and the
// covariance itself.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "identification/fit/fit.hpp"

namespace langer {

struct WithinBounds {
  std::vector<double> low, high;  // (p) NaN of angles of symmetry
  MatX moments;  // (p, p) NaN of those, and throughout where the tests do not determine all others
};

// Nothing where no parameter rests on a bound. Periodic ones have none.
std::optional<WithinBounds> within_bounds(const FitProblem& problem, const FitResult& fit);

// low and high of one parameter: rise(x) = half^2 on either side of 0, but not beyond the box; J
// (m, n), r (m), lower <= 0 <= upper
std::array<double, 2> box_profile(const MatX& J, const VecX& r, const VecX& lower,
                                  const VecX& upper, Eigen::Index of, double half);

}  // namespace langer
