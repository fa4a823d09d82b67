#include "pipeline/sweep/work_precision.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <vector>

namespace langer {

// Linear regression of the values on x = h^p: the intercept is the limit.
Limit fitted_limit(const std::vector<double>& lengths, const std::vector<double>& values,
                   double order) {
  const auto n = static_cast<double>(lengths.size());
  std::vector<double> x;
  for (double h : lengths) x.push_back(std::pow(h, order));
  const double x_mean = std::accumulate(x.begin(), x.end(), 0.0) / n;
  const double f_mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double xx = 0;
  double xf = 0;
  double residual = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - x_mean) * (x[i] - x_mean);
    xf += (x[i] - x_mean) * (values[i] - f_mean);
  }
  const double slope = xf / xx;
  for (std::size_t i = 0; i < x.size(); ++i)
    residual += std::pow(values[i] - f_mean - slope * (x[i] - x_mean), 2);
  return {f_mean - slope * x_mean, order,
          std::sqrt(residual / (n - 2) * (1 / n + x_mean * x_mean / xx))};
}

// With differences that shrink by the constant factor r^p the remaining error is a geometric
// series, whose sum is second / (r^p - 1).
Limit richardson(double coarse, double middle, double fine, double ratio) {
  const double first = coarse - middle;
  const double second = middle - fine;
  if (second == 0) return {fine, 0, 0};
  const double shrinks = first / second;  // r^p
  if (!(shrinks > 1)) return {fine, 0, std::abs(second)};
  const double order = std::log(shrinks) / std::log(ratio);
  const double limit = fine - second / (shrinks - 1);
  // So small an order is chance rather than convergence, and the limit would be far away.
  if (order < 0.5) return {fine, 0, std::abs(second)};
  return {limit, order, std::abs(limit - fine)};
}

// Sorted by cost, a level is on the front if its error is below that of all cheaper ones.
std::vector<int> pareto_front(const std::vector<double>& cost, const std::vector<double>& error) {
  std::vector<std::tuple<double, double, int>> order;  // cost, error, index
  for (int i = 0; i < static_cast<int>(cost.size()); ++i)
    if (std::isfinite(cost[i]) && std::isfinite(error[i])) order.push_back({cost[i], error[i], i});
  std::ranges::sort(order);
  std::vector<int> front;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [level_cost, level_error, level] : order) {
    if (!(level_error < (1 - 1e-6) * least)) continue;
    least = level_error;
    front.push_back(level);
  }
  return front;
}

// The front rises in cost and falls in error, so its first level below the wanted error is the
// cheapest.
int cheapest(const std::vector<double>& cost, const std::vector<double>& error, double wanted) {
  for (int i : pareto_front(cost, error))
    if (error[i] <= wanted) return i;
  return -1;
}

}  // namespace langer
