// Noise that the residuals of a fit show, and what it means for the errors of parameters.
//
// Neighbouring residuals of a measured curve are similar, because a material model misses a curve
// smoothly and load cells drift. A thousand points are then not a thousand measurements. Within a
// curve e_i = rho e_(i-1) + u_i
// (autoregression of first order), curves are independent of each other,
//   covariance of the residuals  V = deviation^2 R + white^2 I,   R_ij = rho^|i-j| within a curve, 0 between curves
// rho and deviation are those of largest restricted likelihood (REML [PT71]), which counts what the
// parameters took from the residuals; rho is 0 where it does not raise that likelihood
// significantly (5 %, one-sided), and where residuals are below 1e-4 of the data, which no load
// cell resolves. Least squares stays as it is; the covariance of its solution is the sandwich (J^T
// J)^-1 J^T V J (J^T J)^-1.
//
// A fit whose noise model is autoregressive (noise_model.hpp) has residuals u from which a
// correlation, `removed`, was taken out beforehand. The restricted likelihood finds a somewhat
// larger one, so that what remains has the covariance
//   V = deviation^2 T R T^T / (1 - rho^2),   T the innovations by `removed`;  V = deviation^2 I where both agree
#pragma once

#include <limits>
#include <vector>

#include "identification/fit/least_squares.hpp"

namespace langer {

struct ResidualNoise {
  std::vector<Eigen::Index> curves;  // values of each, in the order of the residuals
  double deviation = 0, rho = 0;
  double removed = 0;  // correlation that the residuals were freed of; 0: none
  double white = 0;    // further standard deviation, from value to value: noise that is believed in
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

// The same for residuals u = scale T z of a fit with the correlation `removed` > 0: z (m) before
// that operation, J (m, k) its columns. rho is not tested for significance.
ResidualNoise innovation_noise(const VecX& z, const MatX& J,
                               const std::vector<Eigen::Index>& curves, double removed,
                               double scale);

// A_i - rho A_(i-1) within a curve, sqrt(1 - rho^2) A_i at its beginning; and back
MatX innovations(const MatX& A, const std::vector<Eigen::Index>& curves, double rho);
VecX from_innovations(const VecX& u, const std::vector<Eigen::Index>& curves, double rho);

// A correlation over more than the longest curve is the same as a shift of that curve: 1 - 1/n.
double largest_correlation(const std::vector<Eigen::Index>& curves);
// the one of largest likelihood for values z, at most the largest
double most_likely_correlation(const VecX& z, const std::vector<Eigen::Index>& curves);

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

// n ln(sum of squares) of the innovations less the ln of their volume: -2 ln L of the
// autoregression at the best deviation, but for a constant; n ln(|r|^2/n) where rho is 0.
double minus_two_log_likelihood(const VecX& r, const std::vector<Eigen::Index>& curves, double rho);

}  // namespace langer
