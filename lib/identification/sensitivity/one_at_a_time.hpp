// One-at-a-time effects, which the paper calls Morris: one parameter goes from its lower to its
// upper bound in n steps while the others stay at their identified values. [A23] eqs 39-43
//   effect    d^i = (phi(P + Delta) - phi(P))/Delta,  Delta = (upper - lower)/n                       (39-41)
//   mu_star   mean of |d^i|                                                                           (42)
//   s         as printed: sqrt(sum (d^i - mu_star)^2/(n - 1)), signed effects about the mean of their sizes   (43)
//   spread    standard deviation of d^i about their own mean: 0 where phi is linear, which s is not if the slope is negative
// Unlike true Morris trajectories (sensitivity/morris.hpp) this sees no interaction between
// parameters. phi is a curve: every quantity has one value per point of it. Knows no mechanics: any
// callable.
#pragma once

#include <functional>
#include <vector>

#include "core/tensor/types.hpp"

namespace langer {

// fills y (m); false where the parameters have no curve
using ParametricCurve = std::function<bool(const VecX& p, VecX& y)>;

struct OneAtATime {
  MatX mu_star, s, spread;  // (k, m) parameters, points; unit of y over unit of the parameter
  bool complete = false;    // otherwise no curve exists at `missing`
  VecX missing;
};

// value, lower, upper (k), lower < upper; n >= 2 steps
OneAtATime one_at_a_time(const ParametricCurve& phi, const VecX& value, const VecX& lower,
                         const VecX& upper, int n);

// Means over the points of a zone, both ends included: rows as in `of`, one column per zone; NaN in
// a zone without points.
struct Zone {
  double from = 0, to = 0;
};
bool inside(double x, const Zone& zone);
MatX zone_means(const MatX& of, const std::vector<double>& x, const std::vector<Zone>& zones);

}  // namespace langer
