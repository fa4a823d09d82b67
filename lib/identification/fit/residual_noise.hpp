// Noise that the residuals of a fit show. Along a measured curve neighbours are alike, since a law
// misses a curve smoothly and load cells drift: within a curve e_i = rho e_(i-1) + u_i
// (autoregression of first order), curves are independent of each other,
//   covariance of the residuals  V = deviation^2 R + white^2 I,   R_ij = rho^|i-j| within a curve, 0 between curves
// rho and deviation are those of largest restricted likelihood (REML [PT71]), which counts what the
// parameters took from the residuals; rho is 0 where it does not raise that likelihood
// significantly (5 %, one-sided), and where residuals are below 1e-4 of the data, which no load
// cell resolves. Least squares stays as it is; what is known of its answer is the sandwich (J^T
// J)^-1 J^T V J (J^T J)^-1.
#pragma once

#include <limits>
#include <vector>

#include "identification/fit/least_squares.hpp"

namespace langer {

struct ResidualNoise {
  std::vector<Eigen::Index> curves;  // values of each, in the order of the residuals
  double deviation = 0, rho = 0;
  double white = 0;  // further standard deviation, from value to value: noise that is believed in
                     // beyond what the residuals show
  double effective = 0;  // independent values that say as much of a mean: sum over curves of n / (1
                         // + 2 sum_k (1 - k/n) rho^k)
  double freedom =
      std::numeric_limits<double>::infinity();  // degrees of freedom behind `deviation`
  // what the same residuals say of the deviation at a smaller and a larger rho, and how well rho is
  // known
  struct At {
    double rho = 0, deviation = 0;
  };
  At below, above;
  double rho_variance = 0;

  double total() const { return std::hypot(deviation, white); }
};

ResidualNoise white_noise(double deviation, Eigen::Index values);

// r (m) residuals, J (m, k) columns of the parameters that were free; size: root mean square of the
// data
ResidualNoise residual_noise(const VecX& r, const MatX& J, const std::vector<Eigen::Index>& curves,
                             double size);

// the same with noise believed in: where the residuals show less than `least`, the rest is white
ResidualNoise with_least(ResidualNoise noise, double least);

// The variance of direction^T e for noise e, and the degrees of freedom behind it (Satterthwaite's;
// of rho too).
struct NoiseAlong {
  double variance = 0, freedom = 0;
};
NoiseAlong along(const ResidualNoise& noise, const VecX& direction);

// Covariance (p, p) of the parameters. NaN for those left out and for those that the data do not
// determine (a singular combination of columns has part in them).
MatX covariance(const MatX& J, const std::vector<bool>& left_out, const ResidualNoise& noise);

// What 1.96 standard deviations of white noise have to be multiplied by, parameter by parameter,
// for a 95 % interval under this noise: Student's factor over 1.96 times the deviation along the
// part of the column that others cannot replace, over that of white noise of size total(). columns
// (m, p): of a parameter left out too, which otherwise takes no part in the others'.
VecX interval_factors(const MatX& columns, const std::vector<bool>& left_out,
                      const ResidualNoise& noise);

// n ln(sum of squares) of the innovations less the ln of their volume, lowest over rho: -2 ln L of
// the autoregression but for a constant; n ln(|r|^2/n) where rho is 0. To compare laws on the same
// data.
double minus_two_log_likelihood(const VecX& r, const ResidualNoise& noise);

}  // namespace langer
