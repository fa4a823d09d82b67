// Fronts and limits of ladders.
#include "post/trade.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace langer;

TEST_CASE("three members of a power law point to its limit and order") {
  const auto f = [](double h, double order) { return 10.8 - 3 * std::pow(h, order); };
  for (double order : {1.0, 2.0, 3.5}) {
    const Limit limit = richardson(f(0.5, order), f(0.25, order), f(0.125, order), 2);
    CHECK(limit.value == doctest::Approx(10.8).epsilon(1e-12));
    CHECK(limit.order == doctest::Approx(order).epsilon(1e-9));
    CHECK(limit.uncertainty == doctest::Approx(3 * std::pow(0.125, order)).epsilon(1e-9));
  }
}

TEST_CASE("members that do not approach a limit give the finest and their last difference") {
  const Limit turns = richardson(1.0, 1.2, 1.1, 2), grows = richardson(1.0, 1.1, 1.4, 2);
  CHECK(turns.value == 1.1);
  CHECK(turns.order == 0);
  CHECK(turns.uncertainty == doctest::Approx(0.1));
  const Limit slow = richardson(10.7951, 10.7810, 10.7676, 1.4142);
  CHECK(slow.value == 10.7676);
  CHECK(slow.uncertainty == doctest::Approx(0.0134));
  CHECK(grows.value == 1.4);
  CHECK(grows.uncertainty == doctest::Approx(0.3));
  CHECK(richardson(1, 2, 2, 2).uncertainty == 0);
}

TEST_CASE("the front holds what nothing beats in both, failures left out, and the cheapest is on it") {
  const std::vector<double> cost{4, 1, 2, 3, NAN, 0.5, 2}, error{1, 8, 3, 5, 0, NAN, 2};
  CHECK(pareto_front(cost, error) == std::vector<int>{1, 6, 0});
  CHECK(cheapest(cost, error, 8) == 1);
  CHECK(cheapest(cost, error, 2.5) == 6);
  CHECK(cheapest(cost, error, 1) == 0);
  CHECK(cheapest(cost, error, 0.5) == -1);
}
