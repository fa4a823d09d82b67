#include "meshing/grading.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace langer;

namespace {
std::vector<double> steps(const std::vector<double>& x) {
  std::vector<double> s;
  for (std::size_t i = 1; i < x.size(); ++i) s.push_back(x[i] - x[i - 1]);
  return s;
}
std::string refusal(auto act) {
  const auto found = complaints_of(act);
  return found.empty() ? "" : found[0].key + ": " + found[0].found;
}
}  // namespace

TEST_CASE(
    "refined lines: the cells near the end keep their edge, the others grow by one ratio, the length fits") {
  const auto x = refined(15, 11, 0.36, 2.2, "edge");
  REQUIRE(x.size() == 12);
  CHECK(x.front() == 0);
  CHECK(x.back() == 15);
  const auto s = steps(x);
  for (int i = 0; i < 6; ++i) CHECK(s[i] == near(0.36, 1e-12));
  const double growth = s[6] / s[5];
  CHECK(growth > 1);
  for (int i = 7; i < 11; ++i) CHECK(s[i] / s[i - 1] == near(growth, 1e-9));
}

TEST_CASE("lines about a centre at 0 are exact mirror images, for even and odd numbers of cells") {
  for (int n : {1, 2, 5, 22, 55}) {
    for (const auto& x :
         {even_lines(-15, 15, n), n > 4 ? lines_to_centre(-15, 15, n, 30.0 / n / 1.5, 1, "edge")
                                        : even_lines(-15, 15, n)}) {
      REQUIRE(x.size() == static_cast<std::size_t>(n) + 1);
      CHECK(x.front() == -15);
      CHECK(x.back() == 15);
      for (int i = 0; i <= n; ++i) CHECK(x[i] == -x[n - i]);
      for (double s : steps(x)) CHECK(s > 0);
    }
  }
  const auto odd = lines_to_centre(-15, 15, 15, 0.5, 0, "edge");
  CHECK(odd[8] - odd[7] == near(0.5, 1e-12));
}

TEST_CASE("lines to the top: the uppermost cell has its edge") {
  const auto y = lines_to_top(0, 4, 5, 0.5, "edge");
  CHECK(y.back() - y[4] == near(0.5, 1e-12));
  CHECK(y.front() == 0);
  const auto s = steps(y);
  for (int i = 0; i < 4; ++i) CHECK(s[i] > s[i + 1]);
}

TEST_CASE("refinements that cannot fit are refused with both numbers") {
  CHECK(refusal([] { refined(15, 11, 2, 0, "edge"); }) ==
        "edge: 11 cells of 2 mm are longer than 15 mm");
  CHECK(refusal([] { refined(15, 3, 0.1, 0, "edge"); }).find("do not reach 15 mm") !=
        std::string::npos);
  CHECK(refusal([] { refined(15, 11, 15.0 / 11, 0, "edge"); }) == "");  // even cells are the limit
}

TEST_CASE(
    "lines in another number are graded alike: exactly where cells are even or grow by one factor") {
  for (int n : {3, 7, 12, 15, 24}) {
    const auto s = steps(resampled(even_lines(0, 6, 12), n));
    for (double step : s) CHECK(step == near(6.0 / n, 1e-12));
  }
  std::vector<double> growing{0};
  for (int i = 0; i < 12; ++i) growing.push_back(growing.back() + std::pow(1.3, i));
  for (int n : {3, 4, 6, 8, 18, 24}) {
    const auto s = steps(resampled(growing, n));
    REQUIRE(s.size() == static_cast<std::size_t>(n));
    for (int i = 1; i < n; ++i) CHECK(s[i] / s[i - 1] == near(std::pow(1.3, 12.0 / n), 1e-9));
  }
  const auto graded = lines_to_centre(-15, 15, 22, 0.36, 2.2, "edge");
  const auto same = resampled(graded, 22), twice = resampled(graded, 44),
             odd = resampled(graded, 17);
  for (int i = 0; i <= 22; ++i) {
    CHECK(same[i] == near(graded[i], 1e-12));
    CHECK(twice[2 * i] == near(graded[i], 1e-12));
  }
  for (int i = 0; i <= 17; ++i) CHECK(odd[i] == near(-odd[17 - i], 1e-12));
  for (double step : steps(odd)) CHECK(step > 0);
}

TEST_CASE("lines moved through points hit them, stay in order and stay mirror images") {
  const auto lines = lines_to_centre(-15, 15, 22, 0.36, 2.2, "edge");
  const Moved moved = through(lines, {{4, "A"}, {-4, "C"}, {0, "M"}, {0, "B"}}, "x", "divisions");
  for (double at : {-4.0, 0.0, 4.0, -15.0, 15.0})
    CHECK(std::find(moved.lines.begin(), moved.lines.end(), at) != moved.lines.end());
  for (double s : steps(moved.lines)) CHECK(s > 0);
  for (int i = 0; i <= 22; ++i) CHECK(moved.lines[i] == -moved.lines[22 - i]);
  CHECK(moved.furthest > 0);
  CHECK(moved.furthest < 1.3);  // half the largest cell between the centre and 4 mm
  CHECK(through(even_lines(-15, 15, 30), {{4, "A"}, {-4, "C"}}, "x", "divisions").furthest == 0);
}

TEST_CASE("points outside the block, or two points for one line, are refused by name") {
  const auto lines = even_lines(0, 4, 4);
  CHECK(refusal([&] {
          through(lines, {{4.5, "points.A"}}, "y", "divisions");
        }) == "points.A: y = 4.5 is outside the block");
  CHECK(refusal([&] {
          through(lines, {{1.9, "points.A"}, {2.1, "points.B"}}, "y", "divisions");
        }) == "points.B: no grid line is left for y = 2.1, the nearest goes through points.A");
  CHECK(refusal([&] {
          through(even_lines(0, 4, 1), {{2, "points.A"}}, "y", "divisions");
        }) == "points.A: no grid line is left for y = 2");
  CHECK(refusal([&] {
          through(even_lines(0, 4, 1), {{0, "points.A"}, {4, "points.B"}}, "y", "divisions");
        }) == "");
}
