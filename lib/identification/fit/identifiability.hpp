// How well data identify parameters: errors, correlations, combinations that hardly change the
// data, profiles, and which further test would help most. Works on any residual in a box
// (least_squares.hpp), of one test or of many.
//   residuals are divided by the noise, their standard deviation, so that a sum of squares is a chi-square. Where they are
//   correlated (residual_noise.hpp) errors are those of the sandwich, a profile's rise is divided by the square of the factor by
//   which the parameter's interval is wider (adjusted profile [CB07]), and samples are drawn with that correlation
//   sizes     |p|, or the width of the box where p is 0: errors and combinations are relative to them
// Parameters on a bound, and angles of symmetry, are left out of errors and combinations: NaN.
// Profiles have them all the same. Intervals of a periodic parameter lie around its estimate and
// may leave the box; half a period to each side is the whole of it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "identification/fit/residual_noise.hpp"

namespace langer {

struct Identifiability {
  double noise = 0;               // standard deviation of one residual, white part and all
  VecX size;                      // (p) what errors are relative to
  VecX error, correlation_worst;  // (p) standard errors in units of the parameters; largest
                                  // |correlation| with another
  MatX covariance, correlation;
  VecX singular;     // of the Jacobian per size and noise, descending (free parameters)
  MatX combination;  // (p, free) unit columns: changes relative to size, one per singular value
};

// J (m, p) at the optimum; left_out of each parameter
Identifiability identifiability(const MatX& J, const VecX& p, const VecX& size,
                                const std::vector<bool>& left_out, const ResidualNoise& noise);
VecX sizes_of(const LeastSquares& problem, const VecX& p);

// The combination of the smallest singular value in words: "a1 +44 %, a2 -45 %, ... together move
// the data by one standard deviation of the noise in all". Parts below a twentieth of the largest
// are left out.
std::string sloppy_words(const Identifiability& study, const std::vector<std::string>& names,
                         Eigen::Index which);

using ProblemMaker = std::function<LeastSquares()>;  // a problem of its own for each thread

// Chi-square above its minimum when one parameter is held and the others follow. limit: 3.84 for 95
// %.
struct Profile {
  std::vector<double> value, rise;  // ascending by value; the optimum is among them
  double low = 0, high = 0;         // where the rise reaches the limit, or the bound of the box
  bool low_open = false, high_open = false;  // the bound was reached first
};
struct ProfileOptions {
  double limit = 3.841458820694124;
  VecX factor = {};  // (p) of intervals, see interval_factors(); empty: ones
  int threads = 1;
  std::function<void(double)> progress;
};
std::vector<Profile> profiles(const ProblemMaker& maker, const VecX& best, const VecX& error,
                              double noise, const ProfileOptions& options);

// Of one parameter; only low, high and whether they are open are in order.
Profile profile(const LeastSquares& problem, Eigen::Index parameter, const VecX& best, double error,
                double noise, double limit = ProfileOptions{}.limit);

// the rise at one value: at most the limit where the interval holds it
double profile_rise(const LeastSquares& problem, Eigen::Index parameter, double value,
                    const VecX& best, double noise);

// How much wider each interval is for a correlation and a deviation that are estimated, not known.
VecX growth_of_intervals(const MatX& columns, const std::vector<bool>& left_out,
                         const ResidualNoise& noise);

// Fits to the model with fresh noise: the fit's own residuals drawn again, and Gaussian noise where
// more is believed in. Of the residuals the innovations are drawn, centred, in blocks, and put
// together with their correlation again (post-blackened block bootstrap [DH97], section 8.2.3),
// grown to the noise's deviation.
//   growth  further factor on the residuals: Student's over the normal one, for deviation and correlation are estimated too
//   spread  of each parameter: percentiles that lie so many times as far from its estimate. How well the correlation is known counts
//           for a level that all values share, and hardly for what a few of them tell
struct Bootstrap {
  MatX samples;    // (n, p) of the fits that converged; periodic ones within half a period of the
                   // estimate
  VecX low, high;  // percentiles 2.5 and 97.5
  int failed = 0;
};
struct BootstrapOptions {
  int samples = 200;
  std::uint64_t seed = 1;
  double growth = 1;
  VecX spread = {};  // (p); empty: ones
  int threads = 1;
  std::function<void(double)> progress;
};
Bootstrap bootstrap(const ProblemMaker& maker, const VecX& best, const ResidualNoise& noise,
                    const BootstrapOptions& options);

}  // namespace langer
