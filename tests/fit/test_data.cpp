// Tests of any kind from CSV: measures, units, protocols, and what is refused with its place.
#include "identification/fit/test_data.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "core/base/error.hpp"
#include "support/near.hpp"

using namespace langer;

namespace test_data_tests {

namespace {

TestFormat biaxial() {
  TestFormat f;
  f.like.kind = TestKind::biaxial, f.like.measure = StressMeasure::nominal, f.like.name = "s";
  f.strain = StrainMeasure::stretch;
  f.strain_x = "lx", f.strain_z = "lz", f.stress_x = "px_kPa", f.stress_z = "pz_kPa";
  return f;
}

constexpr const char* two_protocols =
    "# five\nprotocol,lx,lz,px_kPa,pz_kPa\na,1.1,1.2,10,20\nb,1.2,1,30,5\na,1.3,1.4,40,50\nb,1.4,1,60,7\n";

std::string refusal(const std::string& text, const TestFormat& format) {
  try {
    tests_of(parse_table(text, "t.csv"), format);
  } catch (const Failure& f) {
    CHECK(f.code() == Exit::input);
    return f.what();
  }
  return "accepted";
}

bool holds(const std::string& said, const std::string& part) {
  CAPTURE(said);
  const bool yes = said.find(part) != std::string::npos;
  CHECK(yes);
  return yes;
}

}  // namespace

TEST_CASE("one file of several protocols: split into tests, or one of them chosen") {
  TestFormat f = biaxial();
  f.split = "protocol";
  const auto tests = tests_of(parse_table(two_protocols, "t"), f);
  REQUIRE(tests.size() == 2);
  CHECK(tests[0].name == "s_a");
  CHECK(tests[0].first == std::vector{1.1, 1.3});
  CHECK(tests[0].second == std::vector{1.2, 1.4});
  CHECK(tests[1].stress_x[1] == near(0.06, 1e-15));
  CHECK(tests[1].stress_z[0] == near(0.005, 1e-15));
  f.split = "", f.where = {{"protocol", "b"}};
  const auto one = tests_of(parse_table(two_protocols, "t"), f);
  REQUIRE(one.size() == 1);
  CHECK(one[0].first == std::vector{1.2, 1.4});
  f.where = {}, f.part.strain_from = 0.15, f.part.strain_to = 0.35;
  CHECK(tests_of(parse_table(two_protocols, "t"), f)[0].first == std::vector{1.2, 1.3});
}

TEST_CASE("strain measures and units become stretches and MPa") {
  TestFormat f;
  f.strain_x = "e", f.stress_x = "s", f.stress_unit = StressUnit::Pa;
  const auto read = [&](const std::string& cell) {
    return tests_of(parse_table("e,s\n0,0\n" + cell + ",5e4\n", "t"), f)[0];
  };
  CHECK(read("0.25").first[1] == 1.25);
  CHECK(read("0.25").stress_x[1] == near(0.05, 1e-15));
  f.strain_unit = StrainUnit::percent;
  CHECK(read("25").first[1] == 1.25);
  f.strain_unit = StrainUnit::fraction, f.strain = StrainMeasure::green_lagrange;
  CHECK(read("0.28125").first[1] == near(1.25, 1e-15));
  f.strain = StrainMeasure::log;
  CHECK(read("0.2").first[1] == near(std::exp(0.2), 1e-15));
  f.like.kind = TestKind::simple_shear;
  CHECK(read("0.2").first == std::vector{0., 0.2});
}

TEST_CASE("what does not fit is refused with its place") {
  TestFormat f = biaxial();
  f.strain_z = "lambda";
  holds(refusal(two_protocols, f),
        "t.csv:2:1: columns.strain_z: no column \"lambda\"; expected one of protocol, lx, lz");
  f = biaxial();
  f.stress_unit = StressUnit::MPa;
  holds(
      refusal(two_protocols, f),
      "stress_unit: MPa for the column \"px_kPa\"; expected the unit that the column's name carries\n"
      "  hint: leave stress_unit out: the name says it");
  f = biaxial();
  f.split = "specimen";
  holds(refusal(two_protocols, f), "split: no column \"specimen\"");
  f = biaxial();
  f.where = {{"protocol", "c"}};
  holds(refusal(two_protocols, f), "found 0 points in the range; expected two at least");
  f = biaxial();
  holds(refusal("lx,lz,px_kPa,pz_kPa\n1,1,0,0\n1.1,-2,x,0\n", f),
        "t.csv:3:5: found the stretch -2; expected a stretch > 0");
  holds(refusal("lx,lz,px_kPa,pz_kPa\n1,1,0,0\n1.1,2,x,0\n", f),
        "t.csv:3:7: found x; expected a finite number");
  holds(refusal("lx,lz,px_kPa,pz_kPa\n1,1,0\n", f), "t.csv:2:1: found 3 cells; expected 4");
  f.stress_x = "lx", f.stress_z = "";
  holds(refusal("lx,lz,px_kPa,pz_kPa\n1,1,0,0\n", f), "stress_unit: no unit for the column \"lx\"");
}

TEST_CASE(
    "a record: cut in time, at rest at its start, over its largest, its first cycle as history") {
  const std::string text =
      "t_s,u_mm,force_N\n0,0,9\n0.5,1,0.5\n1,1,1.5\n2,2,3\n3,3,5\n4,2,3\n5,3,4\n6,3,7\n";
  TestFormat f;
  f.strain_x = "u_mm", f.stress_x = "force_N", f.time = "t_s";
  f.strain_unit = StrainUnit::mm, f.gauge_length = 9, f.stress_unit = StressUnit::N,
  f.strain = StrainMeasure::engineering;
  f.part.time_from = 0.5, f.part.time_to = 5, f.part.compare_from = 3.5;
  f.rest_at_start = f.normalised = true;
  const Test t = parse_tests(text, "record.csv", f).at(0);
  CHECK(t.measure == StressMeasure::nominal);
  CHECK(t.time == std::vector<double>{4, 5});
  CHECK(t.before.time == std::vector<double>{0.5, 1, 2, 3});
  // 9 mm + 1 mm are the length at rest
  CHECK(t.before.first[3] == near(1.2, 1e-14));
  CHECK(t.first[0] == near(1.1, 1e-14));
  CHECK(t.stress_x[0] == near(2.0 / 3, 1e-14));  // of what is compared
  CHECK(t.stress_x[1] == near(1, 1e-14));
}

TEST_CASE("forces that are normalised need no sizes, others do") {
  TestFormat f;
  f.strain_x = "strain", f.stress_x = "force_N";
  CHECK_THROWS_AS(parse_tests("strain,force_N\n0,0\n0.1,2\n", "l.csv", f), Failure);
  f.normalised = true;
  CHECK(parse_tests("strain,force_N\n0,0\n0.1,2\n", "l.csv", f).at(0).stress_x ==
        std::vector<double>{0, 1});
  CHECK_THROWS_AS(parse_tests("strain,force_N\n0,0\n0.1,0\n", "l.csv", f), Failure);
}

}  // namespace test_data_tests
