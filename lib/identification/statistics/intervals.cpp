#include "identification/statistics/intervals.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/no_number.hpp"
#include "identification/fit/identifiability.hpp"

namespace langer {

namespace {

constexpr double limit = 3.841458820694124;  // of chi-square, 95 %
constexpr double tolerance = 0.1;            // of an interval's half width

// Whether the data show noise at all. An exact fit has intervals of the size of its rounding
bool has_noise(const FitProblem& problem, const FitResult& fit) {
  const VecX measured = weights(problem.tests).cwiseProduct(measured_stress(problem.tests));
  return fit.noise.total() > 0 && fit.residual.norm() > 1e-4 * measured.norm();
}

// One end of an interval to first order, and whether the likelihood confirms it.
class EndCheck {
 public:
  EndCheck(const LeastSquares& problem, const FitResult& fit, Eigen::Index parameter, double noise)
      : problem_(problem), fit_(fit), parameter_(parameter), noise_(noise) {}

  bool holds(double end) const {
    const double best = fit_.best.p[parameter_];
    const double inside = clamped(end);
    // an estimate on its bound: the interval has no other end here
    if (inside == best) return true;
    const double rise = profile_rise(problem_, parameter_, inside, fit_.best.p, noise_);
    const double reached = std::sqrt(std::max(rise, 0.) / limit);
    const double expected = (inside - best) / (end - best);
    return std::abs(reached - expected) < tolerance;
  }

  double clamped(double x) const {
    if (problem_.period_of(parameter_) > 0) return x;
    return std::clamp(x, problem_.lower[parameter_], problem_.upper[parameter_]);
  }

 private:
  const LeastSquares& problem_;
  const FitResult& fit_;
  Eigen::Index parameter_;
  double noise_;
};

}  // namespace

// Keeps an interval of first order if the likelihood at both ends confirms it, else takes the
// profile.
std::vector<Interval> intervals_95(const FitProblem& problem, const FitResult& fit,
                                   std::vector<Interval> first) {
  const LeastSquares q = likelihood_problem(problem, fit);
  const bool profiles = !problem.further && fit.columns.size() > 0 && has_noise(problem, fit);
  // beside a bound that is reached, noise counts as in the linearised profile: what rests on it is
  // not left out
  VecX factors = VecX::Ones(fit.best.p.size());
  VecX factors_in_box = factors;
  if (profiles) {
    factors = interval_factors(fit.columns, fit.left_out, fit.noise);
    factors_in_box = interval_factors(fit.columns, fit.symmetric, fit.noise);
  }
  const bool resting = std::find(fit.best.at_bound.begin(), fit.best.at_bound.end(), true) !=
                       fit.best.at_bound.end();
  for (std::size_t k = 0; k < first.size(); ++k) {
    Interval& one = first[k];
    const auto i = static_cast<Eigen::Index>(k);
    const double factor = resting ? factors_in_box[i] : factors[i];
    const EndCheck check(q, fit, i, fit.noise.total() * factor);
    const bool known = std::isfinite(one.low) && std::isfinite(one.high) && !fit.symmetric[k];
    if (profiles && !(known && check.holds(one.low) && check.holds(one.high))) {
      double error = nan;
      if (known) error = (one.high - one.low) / 4;
      const Profile found = profile(q, i, fit.best.p, error, fit.noise.total() * factor);
      one = {found.low, found.high, true};
    }
    if (std::isfinite(one.low)) one.low = check.clamped(one.low);
    if (std::isfinite(one.high)) one.high = check.clamped(one.high);
  }
  return first;
}

}  // namespace langer
