#include "identification/population/chi_square.hpp"

#include <cmath>

namespace langer {

// The regularised incomplete gamma function Q(freedom/2, x/2): a series for small x, a continued
// fraction (Lentz) for large x.
double chi_square_beyond(double chi_square, double freedom) {
  const double a = 0.5 * freedom;
  const double x = 0.5 * chi_square;
  if (!(x > 0)) {
    return 1;
  }
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a;
    double sum = term;
    for (int k = 1; k < 1000 && term > 1e-17 * sum; ++k) {
      term *= x / (a + k);
      sum += term;
    }
    return 1 - front * sum;
  }
  constexpr double tiny = 1e-300;
  double b = x + 1 - a;
  double c = 1 / tiny;
  double d = 1 / b;
  double h = d;
  for (int k = 1; k < 1000; ++k) {
    const double an = -k * (k - a);
    b += 2;
    d = an * d + b;
    if (std::abs(d) < tiny) d = tiny;
    c = b + an / c;
    if (std::abs(c) < tiny) c = tiny;
    d = 1 / d;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return front * h;
}

}  // namespace langer
