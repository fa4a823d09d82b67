// How well a law predicts a test that it was not fitted to: each test in turn is left out, the
// others are fitted again from where the fit of all ended, under the same kind of noise, and the
// test is predicted. Laws that have the same likelihood may differ in this.
#pragma once

#include <vector>

#include "identification/fit/fit.hpp"

namespace langer {

// Root mean square of (predicted - measured) / largest stress of the test, over the tests, each
// counting alike [percent]. NaN where there is one test, or where what remains has too few values
// or no optimum.
double left_out_error(const FitProblem& problem, const FitResult& fit);

// The same of each test, as a share of its largest stress [-].
std::vector<double> left_out_errors(const FitProblem& problem, const FitResult& fit);

}  // namespace langer
