#include "results/post/cycle.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace langer {

namespace {

using Complex = std::complex<double>;

// The first harmonic 2/period * integral of f exp(-i w t) dt from `from` to from + period. f is
// piecewise linear, so the integral over each interval is exact.
Complex harmonic(const std::vector<double>& t, const std::vector<double>& f, double from,
                 double period) {
  const double w = 2 * std::numbers::pi / period;
  const double to = from + period;
  const Complex i(0, 1);
  Complex sum = 0;
  for (std::size_t k = 1; k < t.size(); ++k) {
    const double a = std::max(from, t[k - 1]);
    const double b = std::min(to, t[k]);
    if (!(b > a)) continue;
    const double slope = (f[k] - f[k - 1]) / (t[k] - t[k - 1]);
    // With the time s measured from the middle of the interval, the line is middle + slope s. Its
    // two integrals do not cancel in short intervals:
    //   constant = integral of cos(w s),   linear = integral of s sin(w s)
    const double half = 0.5 * (b - a);
    const double x = w * half;
    const double middle = f[k - 1] + slope * (0.5 * (a + b) - t[k - 1]);
    double constant = 2 * half;
    if (x > 0) constant = 2 * half * (std::sin(x) / x);
    double linear = 2 * half * half * x * (1 - x * x / 10) / 3;  // series for small x
    if (x > 1e-2) linear = 2 * (std::sin(x) - x * std::cos(x)) / (w * w);
    sum += std::exp(-i * (w * (0.5 * (a + b) - from))) * (middle * constant - i * slope * linear);
  }
  return 2 / period * sum;
}

}  // namespace

// The ratio of the first harmonics over the last period, and its change from the period before.
Cycle last_cycle(const std::vector<double>& seconds, const std::vector<double>& x,
                 const std::vector<double>& y, double period) {
  const double last = seconds.back() - period;
  const double before = last - period;
  const auto modulus = [&](double from) {
    return harmonic(seconds, y, from, period) / harmonic(seconds, x, from, period);
  };
  const Complex now = modulus(last);
  Cycle cycle{now.real(), now.imag(), std::numeric_limits<double>::quiet_NaN()};
  if (before >= seconds.front() - 1e-9 * period)
    cycle.change = std::abs(now - modulus(before)) / std::abs(now);
  return cycle;
}

}  // namespace langer
