#include "pipeline/sweep/work_precision.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace langer {

Limit fitted_limit(const std::vector<double>& lengths, const std::vector<double>& values,
                   double order) {
  const auto n = static_cast<double>(lengths.size());
  std::vector<double> x;
  for (double h : lengths) x.push_back(std::pow(h, order));
  const double x_mean = std::accumulate(x.begin(), x.end(), 0.0) / n;
  const double f_mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double xx = 0, xf = 0, left = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - x_mean) * (x[i] - x_mean);
    xf += (x[i] - x_mean) * (values[i] - f_mean);
  }
  const double slope = xf / xx;
  for (std::size_t i = 0; i < x.size(); ++i)
    left += std::pow(values[i] - f_mean - slope * (x[i] - x_mean), 2);
  return {f_mean - slope * x_mean, order,
          std::sqrt(left / (n - 2) * (1 / n + x_mean * x_mean / xx))};
}

Limit richardson(double coarse, double middle, double fine, double ratio) {
  const double first = coarse - middle;
  const double second = middle - fine;
  if (second == 0) return {fine, 0, 0};
  const double shrinks = first / second;
  if (!(shrinks > 1)) return {fine, 0, std::abs(second)};
  // r^p is the ratio of the differences
  const double order = std::log(shrinks) / std::log(ratio);
  const double limit = fine - second / (shrinks - 1);
  if (order < 0.5)
    return {fine, 0, std::abs(second)};  // chance rather than a law: the limit would lie far away
  return {limit, order, std::abs(limit - fine)};
}

std::vector<int> pareto_front(const std::vector<double>& cost, const std::vector<double>& error) {
  std::vector<int> order(cost.size()), front;
  std::iota(order.begin(), order.end(), 0);
  std::erase_if(order, [&](int i) { return !std::isfinite(cost[i]) || !std::isfinite(error[i]); });
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return cost[a] != cost[b] ? cost[a] < cost[b] : error[a] < error[b];
  });
  double least = std::numeric_limits<double>::infinity();
  for (int i : order)
    if (error[i] < (1 - 1e-6) * least) {
      least = error[i];
      front.push_back(i);
    }
  return front;
}

int cheapest(const std::vector<double>& cost, const std::vector<double>& error, double wanted) {
  for (int i : pareto_front(cost, error))
    if (error[i] <= wanted) return i;
  return -1;
}

}  // namespace langer
