#include "identification/fit/left_out.hpp"

#include <cmath>

#include "core/base/error.hpp"
#include "core/base/no_number.hpp"

namespace langer {

namespace {

// mean square error of a prediction of test `left`, over the square of its largest stress
double square_error(const FitProblem& problem, const FitResult& all, std::size_t left) {
  FitProblem others = problem;
  others.tests.erase(others.tests.begin() + static_cast<std::ptrdiff_t>(left));
  others.noise = all.noise_model.kind;
  for (std::size_t i = 0; i < others.free.size(); ++i)
    others.free[i].start = all.best.p[static_cast<Eigen::Index>(i)];
  FitResult refit;
  try {
    refit = fit(others, {.starts = 1});
  } catch (const Failure& failure) {
    // too few values, or no stress, without this test
    if (failure.code() == Exit::input) return nan;
    throw;
  }
  // The fit to all tests is a good start, except where it lies in a flat valley of the others.
  if (!refit.best.converged) refit = fit(others, {.starts = 8});
  if (!refit.best.converged) return nan;
  const Test& test = problem.tests[left];
  const double largest = largest_stress(test);
  VecX predicted(static_cast<Eigen::Index>(test.values()));
  if (!(largest > 0) || !model_stress(refit.material, test, problem.dilatation, predicted.data()))
    return nan;
  const VecX error = (predicted - measured_stress({test})) / largest;
  return error.squaredNorm() / static_cast<double>(error.size());
}

}  // namespace

std::vector<double> left_out_errors(const FitProblem& problem, const FitResult& fit) {
  std::vector<double> errors;
  for (std::size_t left = 0; left < problem.tests.size(); ++left) {
    errors.push_back(std::sqrt(square_error(problem, fit, left)));
  }
  return errors;
}

// The root mean square error of each test predicted from a fit to the others, in percent.
double left_out_error(const FitProblem& problem, const FitResult& fit) {
  const std::size_t n = problem.tests.size();
  if (n < 2 || problem.further) return nan;
  double sum = 0;
  for (const double error : left_out_errors(problem, fit)) sum += error * error;
  return 100 * std::sqrt(sum / static_cast<double>(n));
}

}  // namespace langer
