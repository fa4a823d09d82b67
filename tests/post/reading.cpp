// What devices report: values, slopes and loops of curves with closed forms, and R0 to R9 of a body
// whose creep is known.
#include "results/post/reading.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "support/near.hpp"

using namespace langer;

namespace {

// The height of a linear viscoelastic body under a suction of 1: spring, and a Kelvin element.
double creep(double seconds) {
  if (seconds <= 0) return 0;
  return 0.2 + 0.1 * (1 - std::exp(-seconds / 0.7));
}

// The same under cycles of 2 s suction and 1 s release, from 0.5 s on, by superposition.
double height_of_cycles(double seconds, int cycles) {
  double height = 0;
  for (int k = 0; k < cycles; ++k)
    height += creep(seconds - 0.5 - 3 * k) - creep(seconds - 2.5 - 3 * k);
  return height;
}

ReadingChoice two_and_one() {
  ReadingChoice choice;
  choice.suction_of = "height";
  choice.begins = 0.5;
  choice.suction = 2;
  choice.release = 1;
  return choice;
}

}  // namespace

TEST_CASE("reading: a value is read where the other column first reaches a number") {
  const std::vector<double> over{0, 1, 3, 1, 4};
  const std::vector<double> of{0, 2, 8, 100, 0};
  CHECK(value_where(over, of, 2) == near(5));
  CHECK(value_where(over, of, 3) == near(8));
  CHECK(std::isnan(value_where(over, of, 5)));
  CHECK(std::isnan(value_where(over, of, -1)));
}

TEST_CASE("reading: the slope of a parabola is exact on uneven steps, at the ends too") {
  std::vector<double> x{0, 0.1, 0.4, 0.5, 1, 1.3};
  std::vector<double> y;
  for (const double one : x) y.push_back(2 * one * one - 3 * one);
  for (const double at : {0.02, 0.1, 0.3, 0.45, 0.9, 1.3})
    CHECK(slope_where(x, y, at) == near(4 * at - 3));
}

TEST_CASE("reading: a slope at the turn of a loop takes no state of the way back") {
  const std::vector<double> x{0, 1, 2, 1, 0};
  const std::vector<double> y{0, 1, 4, 0, 0};
  CHECK(slope_where(x, y, 2) == near(4));  // of x^2, which the way out is
}

TEST_CASE("reading: hysteresis is the area of the last loop and its share of the loading") {
  // two cycles: out along y = x to 1, back along y = x/2; out to 2 and back along y = x^2/2
  std::vector<double> x{0, 1, 0, 1, 2};
  std::vector<double> y{0, 1, 0, 1, 2};
  CHECK(std::isnan(last_loop({0, 1, 2}, {0, 1, 2}).loading));  // never back
  const int n = 4000;
  for (int k = n - 1; k >= 0; --k) {
    x.push_back(2.0 * k / n);
    y.push_back(0.5 * x.back() * x.back());
  }
  const Loop loop = last_loop(x, y);
  CHECK(loop.loading == near(2));
  CHECK(std::abs(loop.unloading - 4.0 / 3) < 1e-6);
  CHECK(std::abs(loop.ratio() - 1.0 / 3) < 1e-6);
}

TEST_CASE("reading: R0 to R7 are those of a body whose creep is known, over two cycles") {
  std::vector<double> seconds;
  std::vector<double> height;
  for (int k = 0; k <= 65; ++k) {
    seconds.push_back(0.1 * k);
    // a plate has moved the apex by 0.03 before
    height.push_back(0.03 + height_of_cycles(seconds.back(), 2));
  }
  std::optional<MissingTime> missing;
  const SuctionCycles r = suction_cycles(seconds, height, two_and_one(), missing);
  CHECK_FALSE(missing);
  CHECK(r.cycles == 2);
  CHECK(r.ue == near(creep(0.1)));
  CHECK(r.uf == near(creep(2)));
  CHECK(r.uv() == near(creep(2) - creep(0.1)));
  CHECK(r.ur == near(creep(2) - creep(2.1) + creep(0.1)));
  CHECK(r.ua == near(creep(2) - creep(3) + creep(1)));
  CHECK(r.last_maximum == near(height_of_cycles(5.5, 2)));
  CHECK(r.last_minimum == near(height_of_cycles(6.5, 2)));
  CHECK(r.last_maximum > r.uf);  // residual creep of the first cycle
}

TEST_CASE("reading: a time at which the path has no state is named and nothing is guessed") {
  const std::vector<double> seconds{0, 0.5, 2.5, 3.5};
  const std::vector<double> height{0, 0, 1, 0.2};
  std::optional<MissingTime> missing;
  suction_cycles(seconds, height, two_and_one(), missing);
  REQUIRE(missing);
  CHECK(missing->seconds == near(0.6));
}

TEST_CASE("reading: keys that contradict each other or lack are complaints") {
  ReadingChoice choice;
  CHECK(choice.complaints().size() == 1);  // nothing is read
  choice.value_of = "force";
  CHECK(choice.complaints().size() == 2);  // over, at
  choice.over = "u_ind";
  choice.at = 0.5;
  CHECK(choice.complaints().empty());
  choice.slope_of = "force";
  CHECK(choice.complaints().size() == 1);  // two at once
  ReadingChoice cycles = two_and_one();
  CHECK(cycles.complaints().empty());
  cycles.immediate = 1.5;  // longer than the release
  CHECK(cycles.complaints().size() == 1);
  cycles.over = "u_ind";
  CHECK(cycles.complaints().size() == 2);
}
