// The probability that a chi-square of `freedom` degrees exceeds x.
#pragma once

namespace langer {

double chi_square_beyond(double x, double freedom);

}  // namespace langer
