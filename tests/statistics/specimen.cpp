// What a measured file says of itself, in its header or beside it, and what a config may still
// change.
#include "identification/setup/specimen.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "identification/setup/fit_config_io.hpp"
#include "support/near.hpp"

using namespace langer;
namespace fs = std::filesystem;

namespace {

const std::string folder = BINARY_DIR "/specimen";

void write(const std::string& name, const std::string& text) {
  fs::create_directories(folder);
  std::ofstream(folder + "/" + name) << text;
}

FitConfig read(const std::string& data) {
  const std::string yaml = "data: [" + data +
                           "]\nlaw: {matrix: {neo_hooke: {a1: 1}}, volume: {quadratic: {d: 1}}}\n"
                           "parameters: [{key: matrix.neo_hooke.a1, lower: 0, upper: 1}]\n";
  return read_config<FitConfig>(parse_yaml(yaml, "fit.yaml", folder)).config;
}

std::string refusal(const std::string& data) {
  try {
    measured_tests(read(data));
  } catch (const Failure& f) {
    return f.what();
  }
  return "accepted";
}

void holds(const std::string& said, const std::string& part) {
  CAPTURE(said);
  CHECK(said.find(part) != std::string::npos);
}

constexpr const char* header =
    "# A skin, cut at 30 degrees.\n# ---\n# kind: biaxial\n"
    "# columns: {strain_x: ex, strain_z: ez, stress_x: sx_kPa, stress_z: sz_kPa}\n"
    "# strain: green_lagrange\n# stress: second_piola\n# stress_unit: kPa\n# strain_unit: percent\n# fibre_angle: 30\n"
    "# standard_deviation: 0.02\n# strain_to: 0.2\n# ---\n";
constexpr const char* table = "ex,ez,sx_kPa,sz_kPa\n0,0,0,0\n10.5,22,5,9\n60,22,50,9\n";

}  // namespace

TEST_CASE(
    "A CSV says in its header what it measured: kind, columns, measures, units, angle, deviation, range") {
  write("header.csv", std::string(header) + table);
  const std::vector<Test> tests = measured_tests(read("{file: header.csv}"));
  REQUIRE(tests.size() == 1);
  const Test& t = tests[0];
  CHECK(t.kind == TestKind::biaxial);
  CHECK(t.measure == StressMeasure::second_piola);
  CHECK(t.fibre_angle_deg == 30);
  CHECK(t.weight == near(50));
  REQUIRE(t.points() == 2);        // the third lies beyond strain_to
  CHECK(t.first[1] == near(1.1));  // (1.1^2 - 1)/2 = 10.5 %
  CHECK(t.second[1] == near(1.2));
  CHECK(t.stress_x[1] == near(0.005));
  CHECK(t.stress_z[1] == near(0.009));
}

TEST_CASE("The config wins over the header, a YAML file beside the CSV does as well as a header") {
  write("header.csv", std::string(header) + table);
  const FitConfig c = read("{file: header.csv, fibre_angle: 60, strain_to: 1}");
  CHECK(c.data[0].fibre_angle == 60);
  CHECK(measured_tests(c)[0].points() == 3);
  write("beside.csv", table);
  write(
      "beside.yaml",
      "kind: biaxial\ncolumns: {strain_x: ex, strain_z: ez, stress_x: sx_kPa, stress_z: sz_kPa}\nweight: 3\n");
  const Test t = measured_tests(read("{file: beside.csv}"))[0];
  CHECK(t.kind == TestKind::biaxial);
  CHECK(t.weight == 3);
  // without either the config alone speaks
  write("plain.csv", "strain,cauchy_stress_kPa\n0,0\n0.1,5\n");
  CHECK(measured_tests(read("{file: plain.csv}"))[0].stress_x[1] == near(0.005));
}

TEST_CASE("What is wrong in a header is told at its line and column in the CSV") {
  const auto bad = [](const std::string& lines, const std::string& rows = table) {
    write("bad.csv", "# ---\n" + lines + "# ---\n" + rows);
    return refusal("{file: bad.csv}");
  };
  holds(bad("# kind: biaxal\n"), "bad.csv:2:3: data[0].kind: found biaxal");
  holds(bad("# kinds: biaxial\n"), "bad.csv:2:3: data[0]: unknown key \"kinds\"");
  holds(bad("# fibre_angle: steep\n"), "bad.csv:2:3: data[0].fibre_angle: found steep");
  holds(
      bad("# stress: nominal\n", "strain,cauchy_stress_MPa\n0,0\n0.1,1\n"),
      "bad.csv:4:8: stress: nominal for the column \"cauchy_stress_MPa\"; expected the measure that the column's name carries");
  holds(
      bad("# columns: {strain_x: ex, stress_x: sx_kPa}\n# stress_unit: MPa\n"),
      "stress_unit: MPa for the column \"sx_kPa\"; expected the unit that the column's name carries");
  holds(bad("# file: other.csv\n"), "bad.csv:2:3: found the key \"file\"");
  holds(bad("# - a list\n"), "bad.csv:1:1: found a list between the lines \"# ---\"");
  write("bad.csv", std::string("# ---\n# kind: uniaxial\n") + table);
  holds(refusal("{file: bad.csv}"), "bad.csv:1:1: found a header that does not end");
  write("both.csv", std::string(header) + table);
  write("both.yaml", "kind: uniaxial\n");
  holds(refusal("{file: both.csv}"), "one of the two");
}

TEST_CASE(
    "A config beside a CSV of its name is not taken for what the CSV says; a description with a slip is") {
  write("fit.csv", "strain,cauchy_stress_kPa\n0,0\n0.1,5\n");
  const std::string config =
      "data: [{file: fit.csv}]\nlaw: {matrix: {neo_hooke: {a1: 1}}, volume: {quadratic: {d: 1}}}\n"
      "parameters: [{key: matrix.neo_hooke.a1, lower: 0, upper: 1}]\n";
  write("fit.yaml", config);
  CHECK(read_config<FitConfig>(load_yaml(folder + "/fit.yaml")).config.data[0].file.path ==
        folder + "/fit.csv");
  CHECK(measured_tests(read("{file: fit.csv}")).size() == 1);  // and from another config
  for (
      const char* other :
      {"parameters: [{key: matrix.neo_hooke.a1, around: 0.5}]\nstrain: {from: 0, to: 0.4, points: 3}\nsteps: 10\n",
       "columns: [force]\n", "pipeline: fit\nnodes: {}\n", "- a list\n", "just a text\n", "\n"}) {
    CAPTURE(std::string(other));
    write("fit.yaml", other);
    CHECK(measured_tests(read("{file: fit.csv}")).size() == 1);
  }
  write("fit.yaml", "kind: uniaxial\nfibre_angel: 30\nstress: cauchy\n");
  holds(refusal("{file: fit.csv}"), "fit.yaml:2:1: data[0]: unknown key \"fibre_angel\"");
  fs::remove(folder + "/fit.yaml");
}

TEST_CASE(
    "A force in N over an elongation in mm, described in the config, in the header or beside it") {
  write("lab.csv", "Weg [mm];Kraft [N]\n0,0;0,0\n4,0;2,5\n");
  const std::string sizes = "width: 10, thickness: 2, gauge_length: 40";
  const Test t = measured_tests(read("{file: lab.csv, " + sizes + "}"))[0];
  CHECK(t.first[1] == near(1.1));
  CHECK(t.stress_x[1] == near(0.125));
  CHECK(t.measure == StressMeasure::nominal);
  write("lab.yaml", "width: 10\nthickness: 2\ngauge_length: 40\n");
  CHECK(measured_tests(read("{file: lab.csv}"))[0].stress_x[1] == near(0.125));
  fs::remove(folder + "/lab.yaml");
  holds(refusal("{file: lab.csv, thickness: 2, gauge_length: 40}"),
        "lab.csv:1:10: width: missing, for the column \"Kraft [N]\"");
  holds(refusal("{file: lab.csv, width: 0, thickness: 2, gauge_length: 40}"),
        "data[0].width: found 0");
  holds(
      refusal(
          "{file: lab.csv, kind: simple_shear, toe: 1, columns: {strain_x: \"Weg [mm]\", stress_x: \"Kraft [N]\"}}"),
      "toe: found in simple shear");
  holds(
      refusal(
          "{file: lab.csv, columns: {strain_x: \"Weg [mm]\", strain_z: b, stress_x: \"Kraft [N]\"}}"),
      "kind: biaxial, equibiaxial or pure_shear");
}
