// The same least squares by another method and another library: NLopt's low-discrepancy multistart
// with local searches by sequential quadratic programming (MLSL_LDS, SLSQP), then a simplex search
// that needs no gradient (SBPLX). Two methods that share nothing but the model and agree are a
// reason to believe; a lower cost is a reason not to.
#pragma once

#include <string>

#include "identification/fit/fit.hpp"

namespace langer {

struct Comparison {
  VecX p;
  double cost = 0;
  bool agrees =
      false;  // neither cost is lower by more than 1e-4 of itself and 1e-10 of the data's square
  std::string text;  // the result in one sentence
};

Comparison cross_check(const FitProblem& problem, const LeastSquaresResult& first, unsigned seed,
                       int evaluations = 20000);
// The same for the least squares problem of a largest likelihood (likelihood_problem()).
Comparison cross_check(const LeastSquares& problem, const LeastSquaresResult& first, unsigned seed,
                       int evaluations = 20000);

}  // namespace langer
