// What the noise of measured values is like, and the likelihood of a fit under it.
//
// A residual e_i = weight (model - measured) is taken to be normal with
//   standard deviation  sigma s_i,   s_i^2 = 1 - share + share (f_i / m)^2
//   correlation         of e_i / s_i: rho^|i-j| along a measured curve, none between curves
// f_i is the weighted stress of the model and m the root mean square of the weighted stresses that
// were measured in the tests of the fit. share = 0 is a constant deviation, share near 1 one in
// proportion to the stress.
//
// With the best sigma, -2 ln L is N ln(|u|^2 / N) plus a constant of the data, where
//   u_i = c (z_i - rho z_(i-1)),   u_i = c sqrt(1 - rho^2) z_i at the beginning of a curve
//   z_i = e_i G / s_i,  G the geometric mean of s,  c = (1 - rho^2)^(-curves / (2 N))
// So for known rho and share the largest likelihood is a problem of least squares in u. Everything
// that works on least squares (searches, profiles, bootstrap) works on u as well.
#pragma once

#include <array>
#include <vector>

#include "identification/fit/least_squares.hpp"

namespace langer {

enum class NoiseKind { automatic, white, proportional, autoregressive, both };
constexpr auto names(NoiseKind) {
  return std::array{"auto", "white", "proportional", "autoregressive", "both"};
}

struct NoiseModel {
  NoiseKind kind = NoiseKind::white;
  double rho = 0;        // correlation from one value of a curve to the next
  double share = 0;      // of the variance at stress m: the part that grows with the stress
  double reference = 0;  // m; 0: that of the data at hand

  bool is_white() const { return kind == NoiseKind::white; }
  bool correlated() const { return kind == NoiseKind::autoregressive || kind == NoiseKind::both; }
  bool grows() const { return kind == NoiseKind::proportional || kind == NoiseKind::both; }
  int parameters() const { return static_cast<int>(correlated()) + static_cast<int>(grows()); }
};

// The largest share: at rest the deviation is a hundredth of that at stress m.
constexpr double largest_share = 0.9999;

// Turns residuals of a fit into u.
class Standardizer {
 public:
  // measured: weighted; curves: values of each, in the order of the residuals; rest: values that
  // are zero by definition, which do not count in G
  Standardizer(VecX measured, std::vector<Eigen::Index> curves, std::vector<bool> rest,
               NoiseModel noise);

  VecX scaled(const VecX& e) const;                         // z
  MatX scaled_slope(const VecX& e, const MatX& J) const;    // dz/dp, J = de/dp
  VecX residual(const VecX& e) const;                       // u
  MatX residual_slope(const VecX& e, const MatX& J) const;  // du/dp
  double correlation_scale() const;                         // c
  double normalisation(const VecX& e) const;                // c G
  double size(const VecX& e) const;  // norm of the measured values after the same operations

  const std::vector<Eigen::Index>& curves() const { return curves_; }
  const NoiseModel& noise() const { return noise_; }

 private:
  struct Scales {
    VecX s;           // s_i, G where the specimen is at rest
    VecX relative;    // d ln s_i / d f_i
    double mean = 1;  // G
  };
  Scales scales(const VecX& e) const;
  MatX uncorrelated(const MatX& z) const;

  VecX measured_;
  std::vector<Eigen::Index> curves_;
  std::vector<bool> rest_;
  NoiseModel noise_;
  double root_mean_square_ = 1;
  Eigen::Index counted_ = 0;
};

// The problem whose least squares are the largest likelihood for the noise of `standardizer`.
LeastSquares standardized(const LeastSquares& problem, const Standardizer& standardizer);

// rho and share of largest likelihood for given residuals e, of a kind other than `automatic`
NoiseModel most_likely_noise(const VecX& e, const VecX& measured,
                             const std::vector<Eigen::Index>& curves, const std::vector<bool>& rest,
                             NoiseKind kind);

// N ln(|u|^2 / N)
double minus_two_log_likelihood(const VecX& u);

}  // namespace langer
