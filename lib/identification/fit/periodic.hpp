// Parameters that come again after a period, such as the angle of fibres after 180 degrees.
#pragma once

#include "identification/fit/least_squares.hpp"

namespace langer {

// b - a by the shorter way round
double difference(const LeastSquares& problem, Eigen::Index parameter, double a, double b);

// into the box, by whole periods
double into_box(double x, double period, double lower, double upper);

// At an angle of symmetry a change to either side has the same effect: the first derivative
// vanishes there, and what is known of the angle stands in the second. Such an angle has no part in
// a linear covariance.
struct SymmetricAngles {
  std::vector<bool> at;  // of each parameter: over its own standard error the second-order effect
                         // exceeds the first-order one
  MatX columns;          // J, with d2r/dp_i^2 in place of such a column
};
// turn: after how much each parameter comes again, whatever its box; 0 for those that are no angles
SymmetricAngles symmetric_angles(const LeastSquares& problem, const LeastSquaresResult& best,
                                 double deviation, const std::vector<double>& turn);

}  // namespace langer
