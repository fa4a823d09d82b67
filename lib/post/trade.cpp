#include "post/trade.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace langer {

Limit richardson(double coarse, double middle, double fine, double ratio) {
  const double first = coarse - middle, second = middle - fine;
  if (second == 0) return {fine, 0, 0};
  const double shrinks = first / second;
  if (!(shrinks > 1)) return {fine, 0, std::abs(second)};
  const double order = std::log(shrinks) / std::log(ratio), limit = fine - second / (shrinks - 1);  // r^p is the ratio of the differences
  if (order < 0.5) return {fine, 0, std::abs(second)};  // chance rather than a law: the limit would lie far away
  return {limit, order, std::abs(limit - fine)};
}

std::vector<int> pareto_front(const std::vector<double>& cost, const std::vector<double>& error) {
  std::vector<int> order(cost.size()), front;
  std::iota(order.begin(), order.end(), 0);
  std::erase_if(order, [&](int i) { return !std::isfinite(cost[i]) || !std::isfinite(error[i]); });
  std::sort(order.begin(), order.end(), [&](int a, int b) { return cost[a] != cost[b] ? cost[a] < cost[b] : error[a] < error[b]; });
  double least = std::numeric_limits<double>::infinity();
  for (int i : order)
    if (error[i] < (1 - 1e-6) * least) least = error[i], front.push_back(i);
  return front;
}

int cheapest(const std::vector<double>& cost, const std::vector<double>& error, double wanted) {
  for (int i : pareto_front(cost, error))
    if (error[i] <= wanted) return i;
  return -1;
}

}  // namespace langer
