// Fronts and limits of refinement studies.
#include "pipeline/sweep/work_precision.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace langer;

TEST_CASE("three members of a power law point to its limit and order") {
  const auto f = [](double h, double order) {
    return 10.8 - 3 * std::pow(h, order);
  };
  for (double order : {1.0, 2.0, 3.5}) {
    const Limit limit = richardson(f(0.5, order), f(0.25, order), f(0.125, order), 2);
    CHECK(limit.value == near(10.8, 1e-12));
    CHECK(limit.order == near(order, 1e-9));
    CHECK(limit.uncertainty == near(3 * std::pow(0.125, order), 1e-9));
  }
}

TEST_CASE(
    "members fitted with a given order leave their limit at length 0, and say how sure it is") {
  const std::vector<double> h{0.125, 0.1, 0.0884, 0.0707};
  std::vector<double> values;
  for (double x : h) values.push_back(9.36 + 6.9 * x * x);
  CHECK(fitted_limit(h, values, 2).value == near(9.36, 1e-13));
  CHECK(fitted_limit(h, values, 2).uncertainty < 1e-10);
  const double noise[]{0.003, -0.004, 0.002, -0.001};
  for (std::size_t i = 0; i < h.size(); ++i) values[i] += noise[i];
  const Limit noisy = fitted_limit(h, values, 2);
  CHECK(std::abs(noisy.value - 9.36) < 2 * noisy.uncertainty);
  CHECK(noisy.uncertainty < 0.02);
  // a line through (1, 1), (2, 3), (3, 4): 1.5 x - 1/3, residual variance 1/6
  const Limit line = fitted_limit({1, 2, 3}, {1, 3, 4}, 1);
  CHECK(line.value == near(-1.0 / 3));
  CHECK(line.uncertainty == near(std::sqrt(1.0 / 6 * (1.0 / 3 + 2))));
}

TEST_CASE("members that do not approach a limit give the finest and their last difference") {
  const Limit turns = richardson(1.0, 1.2, 1.1, 2), grows = richardson(1.0, 1.1, 1.4, 2);
  CHECK(turns.value == 1.1);
  CHECK(turns.order == 0);
  CHECK(turns.uncertainty == near(0.1));
  const Limit slow = richardson(10.7951, 10.7810, 10.7676, 1.4142);
  CHECK(slow.value == 10.7676);
  CHECK(slow.uncertainty == near(0.0134));
  CHECK(grows.value == 1.4);
  CHECK(grows.uncertainty == near(0.3));
  CHECK(richardson(1, 2, 2, 2).uncertainty == 0);
}

TEST_CASE(
    "the front holds what nothing beats in both, failures left out, and the cheapest is on it") {
  const std::vector<double> cost{4, 1, 2, 3, NAN, 0.5, 2}, error{1, 8, 3, 5, 0, NAN, 2};
  CHECK(pareto_front(cost, error) == std::vector<int>{1, 6, 0});
  CHECK(cheapest(cost, error, 8) == 1);
  CHECK(cheapest(cost, error, 2.5) == 6);
  CHECK(cheapest(cost, error, 1) == 0);
  CHECK(cheapest(cost, error, 0.5) == -1);
}

TEST_CASE(
    "an error smaller than the uncertainty of the reference counts as large as that: nothing is told for less") {
  const std::vector<double> cost{1, 2, 3, 4, 5}, error{2, 0.4, 0.01, 0.2, NAN};
  std::vector<double> known;
  for (double e : error) known.push_back(known_error(e, 0.3));
  CHECK(known[2] == 0.3);
  CHECK(known[3] == 0.3);
  CHECK(std::isnan(known[4]));
  CHECK(pareto_front(cost, known) ==
        std::vector<int>{0, 1, 2});  // what costs more and is not known to be better is none
  CHECK(cheapest(cost, known, 0.3) == 2);
  CHECK(cheapest(cost, known, 0.29) == -1);
  CHECK(cheapest(cost, error, 0.29) == 2);
}
