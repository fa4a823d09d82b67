// Nonlinear least squares in a box:  min 1/2 |r(p)|^2,  lower <= p <= upper.  Levenberg-Marquardt
// [M63]; each step is the exact solution of the damped linear problem in the box, so that an active
// bound never stops it early.
//   residual   fills r (m); false where p has no model: such a step is shortened
//   typical    sizes of the parameters, for the difference quotients of the Jacobian (taken inside the box)
//   size       size of the residuals that counts as one: the norm of the data. kkt is relative to it.
//   slope      fills J (m, n) at a p that has a model, where the problem knows better than difference quotients; empty: those
// kkt = max over parameters of |J_i| |P(p_i - g_i/|J_i|^2) - p_i| / size, with g = J^T r, J_i a
// column, P the projection on the box: without bounds it is |g_i| / (|J_i| size), the cosine of the
// unexplained part with what p_i can explain. A parameter may have no first effect, |J_i| typical_i
// < 1e-6 size, as a fibre angle has where a test is symmetric: there the gradient itself counts,
// |g_i| typical_i / size^2, and the search goes on if a step to either side lowers the cost, or if
// it changes nothing and lets others lower it (dispersed fibres have no angle). Near such a place
// the curvature of the residual decides, not J: where a search gets slow its diagonal is added to
// J^T J.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/tensor/types.hpp"

namespace langer {

struct LeastSquares {
  std::function<bool(const VecX& p, VecX& r)> residual;
  std::function<bool(const VecX& p, MatX& J)> slope = {};
  VecX start, lower, upper, typical;
  double size = 1;
  bool cheap_slope = false;  // `slope` costs as little as differences: no runs of scenes
  std::vector<bool>
      linear;  // parameters in which r is linear: one difference gives their column; empty: none
  std::vector<double>
      period;  // of parameters that come again, such as angles; 0 for the others; empty: none

  double period_of(Eigen::Index i) const {
    if (period.empty()) return 0;
    return period[static_cast<std::size_t>(i)];
  }
};

struct LeastSquaresOptions {
  int iterations = 500;
  double kkt = 1e-12;
  double step = 0;  // ends, too, where a step changes every parameter by less than this part of
                    // itself; 0: never
  double good_enough = 1e-8;  // kkt where no step lowers the cost any more
};

struct LeastSquaresResult {
  VecX p, r;
  MatX J;  // (m, n) dr/dp
  double cost = 0;
  double kkt = 0;
  int iterations = 0;
  bool converged =
      false;  // kkt reached, or no step within rounding lowers the cost while kkt <= good_enough
  std::string why;
  std::vector<bool> at_bound;
};

LeastSquaresResult least_squares(const LeastSquares& problem,
                                 const LeastSquaresOptions& options = {});

// derivative: the problem's own, or differences of fourth order inside the box; false where the
// model fails
bool jacobian(const LeastSquares& problem, const VecX& p, MatX& J);

// 2 cost/(m - n_free) (J^T J)^-1 over the parameters that are free; NaN rows for those on a bound,
// and for those that the data do not determine (a singular combination of columns has part in
// them), and throughout if m <= n_free
MatX covariance(const LeastSquaresResult& result);

}  // namespace langer
