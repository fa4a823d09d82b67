// Files as testing machines, spreadsheets and scripts write them: what can be read for sure is
// read, the rest is asked about.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "core/base/error.hpp"
#include "identification/fit/test_data.hpp"
#include "support/near.hpp"

using namespace langer;

namespace lab_files_tests {

namespace {

TestFormat sized(double width = 10, double thickness = 2, double length = 40) {
  TestFormat f;
  f.width = width, f.thickness = thickness, f.gauge_length = length;
  return f;
}

std::string refusal(const std::string& text, const TestFormat& format = {}) {
  try {
    parse_tests(text, "l.csv", format);
  } catch (const Failure& f) {
    CHECK(f.code() == Exit::input);
    return f.what();
  }
  return "accepted";
}

void holds(const std::string& said, const std::string& part) {
  CAPTURE(said);
  CAPTURE(part);
  CHECK(said.find(part) != std::string::npos);
}

// two points, stretches 1 and 1.25, nominal stresses 0 and 0.5 MPa
void is_the_test(const std::string& text, const TestFormat& format = {}) {
  CAPTURE(text);
  const Test t = parse_tests(text, "l.csv", format).at(0);
  REQUIRE(t.points() == 2);
  CHECK(t.first[0] == near(1));
  CHECK(t.first[1] == near(1.25));
  CHECK(t.stress_x[0] == near(0));
  CHECK(t.stress_x[1] == near(0.5));
  CHECK(t.measure == StressMeasure::nominal);
}

}  // namespace

TEST_CASE(
    "separators, decimal commas, quotes, preambles, units below the names: one test in many dialects") {
  is_the_test("strain,nominal_stress_MPa\n0,0\n0.25,0.5\n");
  is_the_test("strain;nominal_stress_MPa\n0,00;0,00\n0,25;0,5\n");  // German, French
  is_the_test(
      "\xEF\xBB\xBFstrain\tnominal_stress_MPa\r\n0,0\t0,0\r\n2,5e-1\t5E-1\r\n");  // Excel: BOM,
                                                                                  // tabs, CRLF
  is_the_test(
      "\"strain\",\"nominal_stress_MPa\"\n\"0,0\",\"0,0\"\n\"0,25\",\"0,5\"\n");  // quoted cells
  is_the_test("sep=;\nstrain;nominal_stress_MPa\n0;0\n0,25;0,5\n");               // Excel
  is_the_test("strain;nominal_stress_MPa;\n0,0;0,0;\n\n0,25;0,5;\n;;\n");  // trailing separators,
                                                                           // blank lines
  is_the_test(
      "# made by numpy\n# strain,nominal_stress_MPa\n0.0,0.0\n0.25,0.5\n");  // numpy.savetxt(delimiter=",")
  is_the_test(
      "# strain nominal_stress_MPa\n0.000e+00 0.0e+00\n2.500e-01 5.0e-01\n");  // numpy.savetxt
  is_the_test("strain  nominal_stress_MPa\n 0   0\n 0.25   0.5\n");            // columns of blanks
  is_the_test("strain;nominal stress\n%;kPa\n0;0\n25,0;500,0\n");              // units below
  is_the_test("Strain (%),Nominal stress [kPa]\n0,0\n25,500\n");
  is_the_test("Nominal stress / kPa\tStretch\n0\t1\n500\t1.25\n");
  is_the_test(
      "Machine: Zwick\nDate;22.11.2026\nWidth;10;mm\n\nTechnische Dehnung [%];Technische Spannung [N/mm\xC2\xB2]\n0,0;0,0\n25,0;0,5\n");
  is_the_test("strain,nominal_stress_MPa\r0,0\r0.25,0.5\r");  // old Macintosh
  is_the_test(
      "t;strain;nominal_stress_MPa\n0,5;0;0\n1,234;0,25;0,5\n");  // 1,234 among decimal commas
}

TEST_CASE(
    "forces and elongations become nominal stresses and stretches by the sizes of the specimen") {
  is_the_test("Extension (mm),Force (N)\n0,0\n10,10\n", sized());
  is_the_test("Displacement [mm];Load [mN]\n0,0;0,0\n10,0;10000,0\n", sized());
  is_the_test("Standardweg;Standardkraft\nmm;N\n0,0;0,0\n10,0;10,0\n", sized());
  is_the_test("D\xC3\xA9placement (\xC2\xB5m)\tForce (kN)\n0\t0\n10000\t0,01\n", sized());
  TestFormat f = sized();
  f.strain_x = "Weg", f.stress_x = "Kraft", f.strain_unit = StrainUnit::mm,
  f.stress_unit = StressUnit::N;
  is_the_test("Zeit;Weg;Kraft\n0;0;0\n0,5;10;10\n", f);
  f.strain = StrainMeasure::stretch;  // the length itself
  is_the_test("Zeit;Weg;Kraft\n0;40;0\n0,5;50;10\n", f);
  holds(refusal("Extension (mm),Force (N)\n0,0\n10,10\n"),
        "l.csv:1:1: gauge_length: missing, for the column \"Extension (mm)\"");
  holds(refusal("Extension (mm),Force (N)\n0,0\n10,10\n"),
        "l.csv:1:16: width: missing, for the column \"Force (N)\"");
  holds(refusal("Extension (mm),Force (N)\n0,0\n10,10\n"), "thickness: missing");
  f = sized();
  f.stress = StressMeasure::cauchy;
  holds(refusal("Extension (mm),Force (N)\n0,0\n10,10\n", f),
        "stress: cauchy for the column \"Force (N)\"; expected the measure of a force");
  holds(refusal("Extension,Force (N)\n0,0\n10,10\n", sized()),
        "strain_unit: no unit for the column \"Extension\"");
  holds(refusal("Extension (ft),Force (dyn)\n0,0\n10,10\n", sized()),
        "columns: found Extension (ft), Force (dyn)");
  // each axis of a biaxial test by its own width and length
  TestFormat b = sized(10, 2, 40);
  b.like.kind = TestKind::biaxial, b.width_z = 20, b.gauge_length_z = 80;
  b.strain_x = "ux_mm", b.strain_z = "uz_mm", b.stress_x = "Fx_N", b.stress_z = "Fz_N";
  b.strain = StrainMeasure::engineering;
  const Test t = parse_tests("ux_mm,uz_mm,Fx_N,Fz_N\n0,0,0,0\n4,4,10,10\n", "l.csv", b)[0];
  CHECK(t.first[1] == near(1.1));
  CHECK(t.second[1] == near(1.05));
  CHECK(t.stress_x[1] == near(0.5));
  CHECK(t.stress_z[1] == near(0.25));
  b.width_z.reset();
  holds(refusal("ux_mm,uz_mm,Fx_N,Fz_N\n0,0,0,0\n4,4,10,10\n", b),
        "width_z: missing, for the column \"Fz_N\"");
}

TEST_CASE("blanks in names do not divide columns that commas divide") {
  holds(refusal("strain (mm/m),nominal stress (kPa)\n0,0\n30,3.5\n60,7.1\n"),
        "l.csv:1:1: columns: found strain (mm/m), nominal stress (kPa); expected one column");
}

TEST_CASE("what can be read in two ways is asked about, and the key that is named cures it") {
  const std::string thousands = "strain;nominal_stress_Pa\n1,234;1,500\n2,345;2,500\n";
  holds(refusal(thousands), "l.csv:2:1: found 1,234, and no other number shows");
  TestFormat f;
  f.decimal = DecimalSign::comma;
  CHECK(parse_tests(thousands, "l.csv", f)[0].first[0] == near(2.234));
  const std::string both = "strain;nominal_stress_MPa\n0,1;0.5\n0,2;0.6\n";
  holds(refusal(both), "l.csv:2:1: found 0,1 in a file with 0.5 (line 2)");
  holds(refusal(both, f), "l.csv:2:5: found 0.5; expected a finite number");
  holds(refusal("strain;nominal_stress_MPa\n0,1;0,5\n0,2;1.234,5\n"),
        "l.csv:3:5: found 1.234,5; expected a finite number\n  hint: decimal commas are read here");
  holds(
      refusal("strain,nominal_stress_MPa\n0,1,0,5\n"),
      "l.csv:2:1: found 4 cells; expected 2, as in the line that names the columns\n  hint: decimal commas need");
  holds(refusal("0,0\n0.25,0.5\n"),
        "l.csv:1:1: found numbers where the columns should have their names");
  holds(refusal(std::string("\xFF\xFEs\0t\0", 6)), "l.csv:1:1: found text in UTF-16");
  holds(refusal("Extension (mm),Strain (%),Load (N),Stress (MPa)\n0,0,0,0\n1,2,3,4\n"),
        "a second column of deformation: \"Strain (%)\"");
  f = {};
  f.strain_x = "Strain (%)", f.stress_x = "Stress (MPa)", f.stress = StressMeasure::nominal;
  is_the_test("Extension (mm),Strain (%),Load (N),Stress (MPa)\n0,0,0,0\n1,25,3,0.5\n", f);
}

TEST_CASE(
    "a measure that nobody told is read off the first value, said, or asked for; never engineering and Cauchy without a word") {
  TestFormat f;
  f.strain_x = "a", f.stress_x = "b_MPa";
  const auto read = [&](const std::string& rows) {
    return parse_tests("a,b_MPa\n" + rows, "l.csv", f)[0];
  };
  Test t = read("1,0\n1.25,0.5\n");
  CHECK(t.first[1] == 1.25);
  REQUIRE(t.notes.size() == 2);
  holds(t.notes[0], "l.csv:1:1: \"a\" starts at 1: taken as stretch; say strain: stretch");
  holds(t.notes[1], "l.csv:1:3: the measure of \"b_MPa\" is not known: taken as cauchy");
  t = read("0,0\n0.25,0.5\n");
  CHECK(t.first[1] == 1.25);
  holds(t.notes[0], "taken as engineering strain");
  holds(refusal("a,b_MPa\n0.4,0\n0.5,1\n", f),
        "l.csv:2:1: strain: a column \"a\" that starts at 0.4, neither 0 nor 1");
  f.strain = StrainMeasure::engineering, f.stress = StressMeasure::nominal;
  t = read("0.4,0\n0.5,0.5\n");
  CHECK(t.first[0] == 1.4);
  CHECK(t.notes.empty());
  // `strain` is an engineering strain by its name, unless it starts at 1
  holds(refusal("strain,cauchy_stress_MPa\n1,0\n1.25,0.5\n"),
        "l.csv:2:1: strain: a column \"strain\" that starts at 1");
  f = {};
  f.strain = StrainMeasure::stretch;
  CHECK(parse_tests("strain,cauchy_stress_MPa\n1,0\n1.25,0.5\n", "l.csv", f)[0].first[1] == 1.25);
  f.strain = StrainMeasure::log;
  holds(refusal("stretch,cauchy_stress_MPa\n1,0\n1.25,0.5\n", f),
        "strain: log for the column \"stretch\"; expected the measure that");
  CHECK(parse_tests("True strain (%),true_stress_kPa\n0,0\n10,5\n", "l.csv", {})[0].first[1] ==
        near(std::exp(0.1)));
}

TEST_CASE(
    "the toe: the state at a given stress becomes the one at rest, for any law, stress measure and kind") {
  // P = F/A0 of a body that is strained by l0 before: measured from the toe it is the same body
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(1.02, 1.3);
  for (int n = 0; n < 20; ++n) {
    const double l0 = uniform(random);
    const auto cauchy = [](double l) {
      return 0.2 * (l * l - 1 / l) + 0.1 * std::pow(l - 1, 3);
    };
    std::string text = "stretch,nominal_stress_MPa\n", true_text = "stretch,cauchy_stress_MPa\n";
    for (int i = 0; i <= 400; ++i) {
      const double l = 1 + 0.002 * i;
      text += fmt::format("{:.17g},{:.17g}\n", l, cauchy(l) / l),
          true_text += fmt::format("{:.17g},{:.17g}\n", l, cauchy(l));
    }
    TestFormat f;
    f.toe = cauchy(l0) / l0;
    const Test nominal = parse_tests(text, "l.csv", f)[0];
    f.toe = cauchy(l0);
    const Test real = parse_tests(true_text, "l.csv", f)[0];
    REQUIRE(nominal.points() == real.points());
    CHECK(nominal.first[0] >= 1);
    for (std::size_t i = 0; i < real.points(); ++i) {
      CHECK(real.first[i] * l0 ==
            near(1.8 - 0.002 * static_cast<double>(real.points() - 1 - i), 1e-5));
      CHECK(nominal.stress_x[i] * nominal.first[i] == near(real.stress_x[i], 1e-5));
    }
  }
  TestFormat f;
  f.toe = 3;
  holds(refusal("stretch,nominal_stress_MPa\n1,0\n1.5,2\n", f), "toe: found 3 MPa, and no stress");
  f.toe = 0.5, f.part.strain_to = 0.3;  // the range is counted from the toe
  const Test t =
      parse_tests("stretch,nominal_stress_MPa\n1,0\n1.25,0.5\n1.5,1\n2,2\n", "l.csv", f)[0];
  REQUIRE(t.points() == 2);
  CHECK(t.first[1] == near(1.2));
}

TEST_CASE(
    "axes with grids of their own: the second one is the same specimen turned by 90 degrees") {
  TestFormat f;
  f.like.kind = TestKind::equibiaxial, f.like.fibre_angle_deg = 20, f.like.name = "e";
  f.strain = StrainMeasure::stretch, f.stress = StressMeasure::nominal;
  f.strain_x = "lx", f.strain_z = "lz", f.stress_x = "px_MPa", f.stress_z = "pz_MPa";
  const std::string text = "lx,px_MPa,lz,pz_MPa\n1,0,1,0\n1.1,1,1.15,3\n1.2,2,,\n";
  const std::vector<Test> tests = parse_tests(text, "l.csv", f);
  REQUIRE(tests.size() == 2);
  CHECK(tests[0].first == std::vector{1., 1.1, 1.2});
  CHECK(tests[0].stress_x == std::vector{0., 1., 2.});
  CHECK(tests[1].first == std::vector{1., 1.15});
  CHECK(tests[1].stress_x == std::vector{0., 3.});
  CHECK(tests[1].fibre_angle_deg == 110);
  CHECK(tests[1].name == "e_z");
  f.like.kind = TestKind::pure_shear, f.part.strain_from = 0.05;
  const std::vector<Test> shear =
      parse_tests("lx,px_MPa,lz,pz_MPa\n1,0,1,0\n1.1,1,1.15,3\n1.2,2,1.3,4\n", "l.csv", f);
  REQUIRE(shear.size() == 2);
  CHECK(shear[1].kind == TestKind::biaxial);
  CHECK(shear[1].first == std::vector{1., 1.});
  CHECK(shear[1].second == std::vector{1.15, 1.3});
  CHECK(shear[1].stress_x == std::vector{3., 4.});
  f.like.kind = TestKind::biaxial, f.part.strain_from = -1;
  holds(refusal(text, f), "l.csv:4:7: found nothing");
}

TEST_CASE("any table of numbers in any dialect is read back to the last digit, or refused") {
  std::mt19937 random(3);
  const auto any = [&](int n) {
    return static_cast<int>(random() % static_cast<unsigned>(n));
  };
  for (int n = 0; n < 300; ++n) {
    const bool comma = any(2);
    const std::string separator =
        std::vector<std::string>{comma ? ";" : ",", ";", "\t"}[static_cast<std::size_t>(any(3))];
    const std::string end = any(2) ? "\r\n" : "\n", tail = any(3) ? "" : separator;
    std::string text = any(2) ? "\xEF\xBB\xBF" : "";
    for (int i = any(3); i > 0; --i)
      text += "Specimen" + std::string(any(2) ? separator + "A" : "") + end;
    text += "no" + separator + "Stretch" + separator + "Nominal stress" +
            (any(2) ? " [kPa]" + tail + end
                    : tail + end + separator + "-" + separator + "kPa" + tail + end);
    std::vector<double> stretch, stress;
    const int digits = 1 + any(6);
    for (int i = 0; i < 4; ++i) {
      stretch.push_back(1 + 0.07 * i), stress.push_back(1234.5 * i * i);
      std::string row =
          fmt::format("{}|{:.{}f}|{:.{}f}", i, stretch.back(), digits, stress.back(), digits);
      stretch.back() = std::stod(row.substr(row.find('|') + 1)),
      stress.back() = std::stod(row.substr(row.rfind('|') + 1));
      if (comma) std::replace(row.begin(), row.end(), '.', ',');
      for (std::size_t at; (at = row.find('|')) != std::string::npos;)
        row.replace(at, 1, separator);
      text += row + tail + end;
    }
    CAPTURE(text);
    const Test t = parse_tests(text, "l.csv", {}).at(0);
    CHECK(t.first == stretch);
    for (std::size_t i = 0; i < 4; ++i) CHECK(t.stress_x[i] == near(1e-3 * stress[i], 1e-14));
  }
}

}  // namespace lab_files_tests
