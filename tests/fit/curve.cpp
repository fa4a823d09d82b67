// Measured curves: units, and what is refused, to the line and column.
#include "support/uniaxial.hpp"

#include <doctest/doctest.h>

#include "core/base/error.hpp"
#include "support/near.hpp"

using namespace langer;
using test::Curve, test::parse_curve;

namespace {

std::string refusal(const std::string& text) {
  try {
    parse_curve(text, "c.csv");
  } catch (const Failure& f) {
    CHECK(f.code() == Exit::input);
    return f.what();
  }
  return "accepted";
}

bool starts(const std::string& s, const std::string& with) {
  CAPTURE(s);
  const bool yes = s.starts_with(with);
  CHECK(yes);
  return yes;
}

}  // namespace

TEST_CASE(
    "strain in percent, stretch, kPa and nominal stress are converted by the columns' names") {
  const Curve a = parse_curve("# a comment\nstrain,cauchy_stress_MPa\n0.1,0.5\n\n0.2,0.75\n", "a");
  CHECK(a.strain[0] == near(0.1, 1e-14));
  CHECK(a.strain[1] == near(0.2, 1e-14));
  CHECK(a.stress == std::vector{0.5, 0.75});
  CHECK(a.measure == StressMeasure::cauchy);
  const Curve b = parse_curve(
      "specimen , nominal_stress_kPa , stretch\r\nP1, 500, 1.25\r\nP1, +750, 1.5\r\n", "b");
  CHECK(b.strain == std::vector{0.25, 0.5});
  CHECK(b.stress == std::vector{0.5, 0.75});
  CHECK(b.measure == StressMeasure::nominal);
  const Curve c =
      parse_curve("\xEF\xBB\xBFstrain_percent,cauchy_stress_Pa\n25,5e5\n50,75e4\n", "c");
  CHECK(c.strain == std::vector{0.25, 0.5});
  CHECK(c.stress[1] == near(0.75, 1e-15));
}

TEST_CASE("what is not a finite number is refused with line and column") {
  const std::string head = "strain,cauchy_stress_MPa\n0,0\n";
  starts(refusal(head + "0.1,nan\n"), "c.csv:3:5: found nan; expected a finite number");
  starts(refusal(head + "0.1, inf\n"), "c.csv:3:6: found inf; expected a finite number");
  starts(refusal(head + "0.1,1e154\n"),
         "c.csv:3:5: found 1e154; expected a number of at most 1e+100");
  starts(refusal(head + "0.1,1e999\n"), "c.csv:3:5: found 1e999");
  starts(refusal(head + "0.1,\n"), "c.csv:3:5: found nothing; expected a finite number");
  starts(refusal(head + "0.1,0.2 MPa\n"), "c.csv:3:5: found 0.2 MPa");
  starts(refusal(head + "0.1,0,5\n"), "c.csv:3:1: found 3 cells; expected 2");
  starts(refusal(head + "# x\n0.1\n"), "c.csv:4:1: found 1 cells");
  starts(refusal(head + "-1,0\n"), "c.csv:3:1: found the stretch 0; expected a stretch > 0");
}

TEST_CASE("all bad cells are told at once, up to ten lines") {
  const std::string all = refusal("strain,cauchy_stress_MPa\nx,y\n0.1,0.2\n0.2,z\n");
  CHECK(
      all ==
      "c.csv:2:1: found x; expected a finite number\nc.csv:2:3: found y; expected a finite number\n"
      "c.csv:4:5: found z; expected a finite number");
  std::string many = "strain,cauchy_stress_MPa\n";
  for (int i = 0; i < 1000; ++i) many += "0,?\n";
  const std::string told = refusal(many);
  CHECK(std::count(told.begin(), told.end(), '\n') == 9);
}

TEST_CASE("columns that are missing, doubled or without unit are refused") {
  starts(refusal("strain,stress\n0,0\n"),
         "c.csv:1:8: stress_unit: no unit for the column \"stress\"");
  starts(
      refusal("strain,stress_MPa\n0,0\n"),
      "c.csv:1:8: stress: not known for the column \"stress_MPa\"; expected stress: cauchy (true) or nominal");
  starts(refusal("time,force\n0,0\n"),
         "c.csv:1:1: columns: found time, force; expected one column of strain");
  starts(refusal("strain,cauchy_stress_torr\n0,0\n"),
         "c.csv:1:1: columns: found strain, cauchy_stress_torr");
  starts(refusal("strain,stretch,cauchy_stress_MPa\n0,1,0\n"),
         "c.csv:1:8: columns: a second column of deformation: \"stretch\"");
  starts(refusal("strain,cauchy_stress_MPa\n0,0\n"),
         "c.csv: found 1 points; expected two at least");
  starts(refusal(""), "c.csv: found 0 points");
  starts(refusal(std::string("\0\1\2\xff\n", 5)), "c.csv:1:1: found a binary file");
}

TEST_CASE("a missing file is refused by name") {
  try {
    read_tests("no/such/curve.csv", {});
    CHECK(false);
  } catch (const Failure& f) {
    CHECK(f.code() == Exit::input);
    starts(f.what(), "no/such/curve.csv: there is no such file");
  }
}

TEST_CASE("a range of strain keeps both ends") {
  const auto points = [](double from, double to) {
    TestFormat f;
    f.part.strain_from = from, f.part.strain_to = to;
    return parse_tests("strain,cauchy_stress_MPa\n0,0\n0.25,1\n0.5,2\n0.75,3\n", "c", f)[0]
        .stress_x;
  };
  CHECK(points(0.25, 0.5) == std::vector{1., 2.});
  CHECK_THROWS_AS(points(1, 2), Failure);
}
