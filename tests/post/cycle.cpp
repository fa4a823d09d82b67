// Storage and loss of the last cycle, against what a linear material answers.
#include "results/post/cycle.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

using namespace langer;

namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

TEST_CASE(
    "cycle: storage and loss of two sines are those of their amplitudes and phase, whatever stands before the last cycle") {
  const double period = 0.7, modulus = 3.2, delta = 0.31;
  std::vector<double> t, x, y;
  for (int i = 0; i <= 4000; ++i) {
    const double s = 2.5 * period * i / 4000 + 0.01 * period * std::sin(0.37 * i) *
                                                   (i > 0 && i < 4000);  // states not at even times
    const bool early = s < 0.45 * period;
    t.push_back(s), x.push_back(early ? 7 : 0.2 + 0.01 * std::sin(2 * pi * s / period));
    y.push_back(early ? -3 : 5 + 0.01 * modulus * std::sin(2 * pi * s / period + delta));
  }
  std::sort(t.begin(), t.end());
  for (std::size_t i = 0; i < t.size(); ++i)
    if (t[i] >= 0.45 * period)
      x[i] = 0.2 + 0.01 * std::sin(2 * pi * t[i] / period),
      y[i] = 5 + 0.01 * modulus * std::sin(2 * pi * t[i] / period + delta);
  const Cycle cycle = last_cycle(t, x, y, period);
  CHECK(cycle.storage == near(modulus * std::cos(delta), 1e-5));
  CHECK(cycle.loss == near(modulus * std::sin(delta), 1e-5));
  CHECK(cycle.tan_delta() == near(std::tan(delta), 1e-5));
  CHECK(cycle.change < 1e-4);
}

TEST_CASE(
    "cycle: straight lines are integrated exactly, in long and in short intervals, and one cycle has none before it") {
  // a triangle from 0 to 1 and back, answered by itself a quarter later: i^-1 = -i
  std::vector<double> t, x, y;
  for (int i = 0; i <= 4; ++i)
    for (double more : {0., 1e-9}) {  // an interval that hardly lasts
      if (i == 4 && more > 0) break;
      t.push_back(0.25 * i + more);
      x.push_back(1 - std::abs(2 * t.back() - 1));
      const double u = std::fmod(t.back() + 0.75, 1.);
      y.push_back(1 - std::abs(2 * u - 1));
    }
  const Cycle cycle = last_cycle(t, x, y, 1);
  CHECK(std::abs(cycle.storage) < 1e-8);
  CHECK(cycle.loss == near(-1, 1e-8));
  CHECK(std::isnan(cycle.change));
}

TEST_CASE("cycle: a triangle's first harmonic has the modulus of a sine in a branch") {
  // y' + y/tau = gamma x', exactly between the kinks of x
  const double tau = 0.3, gamma = 0.8, period = 1;
  std::vector<double> t{0}, x{0}, y{0};
  for (int i = 1; i <= 12 * 400; ++i) {
    const double s = i * period / 400,
                 now = 1 - std::abs(2 * (s / period - std::floor(s / period)) - 1),
                 dt = period / 400;
    const double k = std::exp(-dt / tau), follow = gamma * (1 - k) * tau / dt;
    y.push_back(k * y.back() + follow * (now - x.back()));
    t.push_back(s), x.push_back(now);
  }
  std::vector<double> sum;
  for (std::size_t i = 0; i < x.size(); ++i) sum.push_back(x[i] + y[i]);
  const std::complex<double> i_w_tau(0, 2 * pi * tau / period),
      exact = 1. + gamma * i_w_tau / (1. + i_w_tau);
  const Cycle cycle = last_cycle(t, x, sum, period);
  CHECK(cycle.storage == near(exact.real(), 1e-4));
  CHECK(cycle.loss == near(exact.imag(), 1e-4));
  CHECK(cycle.change < 1e-9);
}
