// Files as laboratories write them: each layout is read right, or asks one question whose answer
// works.
//
// Every layout holds the same tension test unless it says otherwise: stretches 1, 1.125 and 1.25,
// nominal stresses 0, 0.2 and 0.5 MPa, of a specimen 10 mm wide, 2 mm thick and 40 mm long.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/base/error.hpp"
#include "core/config/writer.hpp"
#include "identification/setup/fit_config_io.hpp"

using namespace langer;

namespace {

struct Layout {
  std::string name;
  std::string file;      // its name
  std::string text;      // what it holds
  std::string keys;      // of the item of data, in front of the question
  std::string question;  // part of the one message; empty: it is read as it stands
  std::string answer;    // the keys that the message leads to; empty: the file has to be changed
  std::vector<double> stretch{1, 1.125, 1.25};
  std::vector<double> stress{0, 0.2, 0.5};
  StressMeasure measure = StressMeasure::nominal;
  std::vector<double> time{};
};

const std::string sizes = "width: 10, thickness: 2, gauge_length: 40";

std::string columns(const std::string& strain, const std::string& stress,
                    const std::string& more = "") {
  return fmt::format("columns: {{strain_x: \"{}\", stress_x: \"{}\"{}}}", strain, stress, more);
}

std::vector<Test> read(const Layout& layout, const std::string& keys) {
  const std::string folder = BINARY_DIR "/tests/laboratory";
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/" + layout.file, std::ios::binary) << layout.text;
  const std::string viscous =
      keys.find("time:") == std::string::npos ? "" : ", viscous: [{tau: 1, gamma: 0.5}]";
  const std::string yaml = fmt::format(
      "data: [{{file: {}{}{}}}]\nlaw: {{matrix: {{neo_hooke: {{a1: 0.1}}}}, volume: "
      "{{quadratic: {{d: 1e-6}}}}{}}}\nbounds: admissible\nparameters: [{{key: "
      "matrix.neo_hooke.a1}}]\n",
      layout.file, keys.empty() ? "" : ", ", keys, viscous);
  return measured_tests(read_config<FitConfig>(parse_yaml(yaml, "fit.yaml", folder)).config);
}

// All messages, one below the other; empty where the file is read.
std::vector<std::string> questions(const Layout& layout, const std::string& keys) {
  try {
    read(layout, keys);
  } catch (const Failure& failure) {
    std::vector<std::string> all;
    for (const Error& e : failure.errors()) all.push_back(text(e));
    return all;
  }
  return {};
}

void check_values(const std::vector<double>& found, const std::vector<double>& expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(std::abs(found[i] - expected[i]) < 1e-7);
  }
}

void check_layout(const Layout& layout) {
  CAPTURE(layout.name);
  std::string keys = layout.keys;
  if (!layout.question.empty()) {
    const std::vector<std::string> asked = questions(layout, keys);
    REQUIRE(asked.size() == 1);
    CAPTURE(asked[0]);
    CHECK(asked[0].find(layout.question) != std::string::npos);
    if (layout.answer.empty()) {
      return;
    }
    keys = layout.answer;
  }
  for (const std::string& question : questions(layout, keys)) {
    FAIL(question);
  }
  const Test test = read(layout, keys).front();
  check_values(test.first, layout.stretch);
  check_values(test.stress_x, layout.stress);
  CHECK(test.measure == layout.measure);
  if (!layout.time.empty()) check_values(test.time, layout.time);
}

const std::string plain = "strain,nominal_stress_MPa\n0,0\n0.125,0.2\n0.25,0.5\n";

std::vector<Layout> layouts_of_machines() {
  return {
      {"Zwick, German", "zwick.csv",
       "Pr\xC3\xBC"
       "fer;Meier\nStandardweg;Standardkraft\nmm;N\n0,0;0,0\n5,0;4,0\n10,0;10,0\n",
       sizes},
      {"units behind a slash", "slash.txt", "Weg/mm\tKraft/N\n0\t0\n5\t4\n10\t10\n", sizes},
      {"Instron: one of two blocks", "blocks.csv",
       "\"Specimen 1\"\n\"Extension (mm)\",\"Load (N)\"\n\"0\",\"0\"\n\"3\",\"2\"\n\n\"Specimen "
       "2\"\n\"Extension (mm)\",\"Load "
       "(N)\"\n\"0\",\"0\"\n\"5\",\"4\"\n\"10\",\"10\"\n",
       sizes + ", block: Specimen 3",
       "no block \"Specimen 3\"; expected one of Specimen 1, Specimen 2",
       sizes + ", block: Specimen 2"},
      {"gram-force, pulling counts negative, a comma before the unit", "mach.txt",
       "<INFO>\nDate:\tMon, Jan 03, 2022\n<END INFO>\n<DATA>\nTime, s\tPosition (z), mm\tFz, "
       "gf\n0\t0\t0\n1\t-50\t-4078.8649\n2\t-100\t-10197.1621\n",
       "width: 10, thickness: 20, gauge_length: 40",
       "found the stretch -0.25; expected a stretch > 0",
       "width: 100, thickness: 2, gauge_length: 400, sign: -1"},
      {"a position that does not start at 0", "position.csv",
       "Position (mm),Load (N)\n31.5,0\n36.5,4\n41.5,10\n", sizes,
       "the position \"Position (mm)\", which does not start at 0"},
      {"kilogram-force", "kgf.csv",
       "Stroke (mm),Force (kgf)\n0,0\n5,0.4078864852\n10,1.019716213\n", sizes},
      {"pounds and inches", "lbf.csv",
       "Extension (in),Load (lbf)\n0,0\n0.1968503937,0.8992357739\n0.3937007874,2.2480894387\n",
       sizes},
      {"psi and in/in, in a line of units", "psi.csv",
       "Strain,Eng. stress\nin/in,psi\n0,0\n0.125,29.007547546\n0.25,72.518868865\n", ""},
      {"a preamble and the names of axes", "axes.csv",
       "Machine;A\nlambda_x;nominal_stress_x_kPa\n1;0\n1,125;200\n1,25;500\n", ""},
      {"numpy.savetxt", "numpy.csv", "# strain,nominal_stress_MPa\n0,0\n0.125,0.2\n0.25,0.5\n", ""},
      {"Excel: byte-order mark, tabs, decimal commas", "excel.txt",
       "\xEF\xBB\xBFStrain (%)\tEngineering stress (kPa)\r\n0,0\t0,0\r\n12,5\t200\r\n25,0\t500\r\n",
       ""},
      {"a workbook", "curve.xlsx", std::string("PK\x03\x04\x14\0\x06\0", 8), "",
       "found a workbook (.xlsx, .ods) or another zip archive; expected a table as text (CSV)"},
      {"an old workbook", "curve.xls", "\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", "",
       "found a workbook of old Excel (.xls)"},
      {"a compressed table", "curve.csv.gz", std::string("\x1f\x8b\x08\0\0", 5), "",
       "found a file compressed by gzip"},
      {"a document", "curve.pdf", "%PDF-1.5\n%\xD0\xD4\n", "", "found a PDF document"},
      {"a web page called a workbook", "page.xls", "\n<HTML><body><table>", "",
       "found a web page or XML"},
      {"variables of MATLAB", "curve.mat", std::string("MATLAB 5.0 MAT-file\0\1IM", 24), "",
       "found a binary file"},
      {"a line of a machine in angle brackets", "machine.txt",
       "<Machine A>\nstretch;nominal_stress_kPa\n1;0\n1.125;200\n1.25;500\n", ""},
      {"sizes in the file's name", "S3_w10_t2p0_L40.csv",
       "Extension (mm),Load (N)\n0,0\n5,4\n10,10\n", "name_pattern: \"S{width}_{thickness}\"",
       "name_pattern: found the name S3_w10_t2p0_L40",
       "name_pattern: \"*_w{width}_t{thickness}_L{gauge_length}\""},
  };
}

std::vector<Layout> layouts_of_measures() {
  const std::string two_axes = "stretch,b\n1,0\n1.125,200\n1.25,500\n";
  return {
      {"first Piola-Kirchhoff", "piola.csv",
       "stretch;First Piola-Kirchhoff stress (kPa)\n1;0\n1.125;200\n1.25;500\n",
       columns("stretch", "First Piola-Kirchhoff stress (kPa)")},
      {"PK1", "pk1.csv", "lambda;PK1 (kPa)\n1;0\n1.125;200\n1.25;500\n",
       columns("lambda", "PK1 (kPa)")},
      {"P11 and F11", "p11.csv", "F11;P11 (kPa)\n1;0\n1.125;200\n1.25;500\n",
       columns("F11", "P11 (kPa)")},
      {"Eng. strain, Eng. stress", "eng.csv",
       "Eng. strain [%];Eng. stress [MPa]\n0;0\n12.5;0.2\n25;0.5\n",
       columns("Eng. strain [%]", "Eng. stress [MPa]")},
      {"second Piola-Kirchhoff and Green's strain",
       "second.csv",
       "Green strain E11;2nd PK stress S11 (kPa)\n0;0\n0.1328125;177.7777778\n0.28125;400\n",
       columns("Green strain E11", "2nd PK stress S11 (kPa)"),
       "",
       "",
       {1, 1.125, 1.25},
       {0, 0.1777777778, 0.4},
       StressMeasure::second_piola},
      {"true strain and true stress",
       "true.csv",
       "True strain,True stress (MPa)\n0,0\n0.1177830357,0.225\n0.2231435513,0.625\n",
       "",
       "",
       "",
       {1, 1.125, 1.25},
       {0, 0.225, 0.625},
       StressMeasure::cauchy},
      {"S11, which two schools read differently",
       "s11.csv",
       "stretch,S11 (MPa)\n1,0\n1.125,0.225\n1.25,0.625\n",
       columns("stretch", "S11 (MPa)"),
       "which is the second Piola-Kirchhoff stress in textbooks, Cauchy's in Abaqus; expected "
       "stress: cauchy",
       columns("stretch", "S11 (MPa)") + ", stress: cauchy",
       {1, 1.125, 1.25},
       {0, 0.225, 0.625},
       StressMeasure::cauchy},
      {"Piola-Kirchhoff without a number", "pk.csv",
       "stretch,Piola-Kirchhoff stress (MPa)\n1,0\n1.125,0.2\n1.25,0.5\n", "",
       "which does not say which of the two Piola-Kirchhoff stresses", "stress: nominal"},
      {"a key that contradicts the heading", "contradiction.csv",
       "stretch,PK1 (MPa)\n1,0\n1.125,0.2\n1.25,0.5\n", "stress: cauchy",
       "contradiction.csv:1:9: stress: cauchy for the column \"PK1 (MPa)\"", "stress: nominal"},
      {"a strain key that contradicts the heading", "log.csv",
       "Hencky strain,Nominal stress (MPa)\n0,0\n0.1177830357,0.2\n0.2231435513,0.5\n",
       "strain: engineering", "strain: engineering for the column \"Hencky strain\"",
       "strain: log"},
      {"stress and strain exchanged", "exchanged.csv",
       "Strain,Nominal stress (MPa)\n0,0\n0.125,0.2\n0.25,0.5\n",
       columns("Nominal stress (MPa)", "Nominal stress (MPa)"),
       "columns.strain_x: the column \"Nominal stress (MPa)\"; expected a column of deformation",
       columns("Strain", "Nominal stress (MPa)") + ", strain: engineering"},
      {"a stress without a measure", "none.csv", "stretch,stress (MPa)\n1,0\n1.125,0.2\n1.25,0.5\n",
       "", "stress: not known for the column \"stress (MPa)\"", "stress: nominal"},
  };
}

std::vector<Layout> layouts_of_signs() {
  const std::vector<double> pressed{1, 0.95, 0.8};
  const std::vector<double> bearing{0, -0.1, -0.5};
  return {
      {"stretches below 1 with stresses above 0", "mixed.csv",
       "stretch,nominal_stress_MPa\n1,0\n0.95,0.1\n0.8,0.5\n", "",
       "stress_sign: found a stretch of 0.8 with a stress of 0.5 MPa", "stress_sign: -1", pressed,
       bearing},
      {"the same, turned by sign", "mixed_sign.csv",
       "stretch,nominal_stress_MPa\n1,0\n0.95,0.1\n0.8,0.5\n", "sign: -1", "", "", pressed,
       bearing},
      {"compression by its heading", "press.csv",
       "Compressive strain (%),Nominal stress (MPa)\n0,0\n5,0.1\n20,0.5\n", "",
       "sign: found a compression test by its name", "sign: -1", pressed, bearing},
      {"compression by the file's name", "comp_3.csv",
       "strain,nominal_stress_MPa\n0,0\n0.05,0.1\n0.2,0.5\n", "",
       "sign: found a compression test by its name", "sign: -1", pressed, bearing},
      {"tension whose file's name says compression", "compression_tension.csv", plain, "",
       "sign: found a compression test by its name", "sign: 1"},
      {"strains above 0 with stresses below 0", "strain_only.csv",
       "strain,nominal_stress_MPa\n0,0\n0.05,-0.1\n0.2,-0.5\n", "",
       "stress_sign: found a stretch of 1.2 with a stress of -0.5 MPa", "strain_sign: -1", pressed,
       bearing},
      {"a sign that is none", "sign_2.csv", plain, "sign: -2",
       "sign: found a factor; expected 1 or -1", "sign: 1"},
      {"compression to tension in one rising column",
       "ct.csv",
       "strain,nominal_stress_MPa\n-0.1,-0.02\n0,0\n0.1,0.009\n",
       "",
       "",
       "",
       {0.9, 1, 1.1},
       {-0.02, 0, 0.009}},
  };
}

std::vector<Layout> layouts_of_parts() {
  const std::string cycles =
      "strain,nominal_stress_MPa\n0,0\n0.1,0.3\n0.2,0.6\n0.1,0.1\n0,0\n0.125,0.2\n0.25,0.5\n0.1,0."
      "1\n0.01,0\n";
  const std::string wide =
      "S1 strain,S1 stress (kPa),S2 strain,S2 stress (kPa)\n0,0,0,0\n0.1,100,0.125,200\n0.2,300,0."
      "25,500\n0.3,600,,\n0.4,1000,#N/A,#N/A\n";
  const std::string twins =
      "Strain,Stress (MPa),Strain,Stress (MPa)\n0,0,0,0\n0.1,0.1,0.125,0.2\n0.2,0.3,0.25,0.5\n0.3,0."
      "6,NaN,NaN\n";
  return {
      {"side by side, of different length", "wide.csv", wide, "", "columns: found S1 strain",
       columns("S2 strain", "S2 stress (kPa)") + ", strain: engineering, stress: nominal"},
      {"side by side, of one name", "twins.csv", twins, columns("Strain", "column 4", ", time: x"),
       "columns.time: no column \"x\"",
       columns("column 3", "column 4") + ", strain: engineering, stress: nominal"},
      {"#N/A at the end", "na_end.csv", plain + "#N/A,#N/A\nNaN,NaN\n,\n", ""},
      {"#N/A between points", "na.csv", "strain,nominal_stress_MPa\n0,0\n#N/A,0.2\n0.25,0.5\n", "",
       "na.csv:3:1: found #N/A; expected a finite number"},
      {"a stress without its strain at the end", "half.csv", plain + ",0.6\n", "",
       "half.csv:5:1: found nothing; expected a finite number"},
      {"up to the peak", "peak.csv", plain + "0.3,0.3\n0.35,0.1\n", "until: peak"},
      {"the loading branch", "loading.csv", plain + "0.2,0.3\n0.1,0.1\n0,0\n", "branch: loading"},
      {"the unloading branch",
       "unloading.csv",
       "strain,nominal_stress_MPa\n0,0\n0.1,0.3\n0.25,0.6\n0.125,0.2\n0,0\n",
       "branch: unloading",
       "",
       "",
       {1.25, 1.125, 1},
       {0.6, 0.2, 0}},
      {"the last cycle's loading branch", "cycles.csv", cycles, "cycle: last, branch: loading"},
      {"without the first cycle",
       "cycles_2.csv",
       cycles,
       "skip_cycles: 1",
       "",
       "",
       {1, 1.125, 1.25, 1.1, 1.01},
       {0, 0.2, 0.5, 0.1, 0}},
      {"more cycles than there are", "cycles_3.csv", cycles, "skip_cycles: 2",
       "skip_cycles: found 2 loading branches", "skip_cycles: 1, branch: loading"},
  };
}

std::vector<Layout> layouts_of_times() {
  const auto timed = [](const std::string& heading, const std::string& times) {
    const std::vector<std::string> rows{"0,0", "0.125,0.2", "0.25,0.5"};
    std::string text = heading + ",strain,nominal_stress_MPa\n";
    std::size_t begin = 0;
    for (const std::string& row : rows) {
      const std::size_t end = times.find(' ', begin);
      text += times.substr(begin, end - begin) + "," + row + "\n";
      begin = end + 1;
    }
    return text;
  };
  const auto with_time = [](const std::string& heading) {
    return columns("strain", "nominal_stress_MPa", ", time: \"" + heading + "\"");
  };
  const Layout base{
      "",          "", "", "", "", "", {1, 1.125, 1.25}, {0, 0.2, 0.5}, StressMeasure::nominal,
      {0, 60, 120}};
  std::vector<Layout> all;
  const auto add = [&](const std::string& heading, const std::string& times,
                       const std::string& more = "") {
    Layout layout = base;
    layout.name = heading;
    layout.file = fmt::format("time_{}.csv", all.size());
    layout.text = timed(heading, times);
    layout.keys = with_time(heading) + more;
    all.push_back(layout);
  };
  add("Time (min)", "0 1 2 ");
  add("Time [h]", "0 0.016666666667 0.033333333333 ");
  add("t_ms", "0 60000 120000 ");
  add("Minutes", "0 1 2 ");
  add("Zeit / Minuten", "0 1 2 ");
  add("Elapsed time (sec)", "0 60 120 ");
  add("time_s", "0 60 120 ");
  add("Time", "0 60 120 ");
  add("Time", "0 1 2 ", ", time_unit: min");
  add("Time (frames)", "0 60 120 ");
  all.back().question = "time_unit: the unit \"frames\" of the column \"Time (frames)\"";
  all.back().answer = all.back().keys + ", time_unit: s";
  add("Time (min)", "0 1 2 ", ", time_unit: s");
  all.back().question = "time_unit: s for the column \"Time (min)\"";
  all.back().answer = with_time("Time (min)");
  return all;
}

}  // namespace

TEST_CASE("layouts of machines and spreadsheets are read right or ask one question") {
  for (const Layout& layout : layouts_of_machines()) check_layout(layout);
}

TEST_CASE("headings name the measure of stress and strain") {
  for (const Layout& layout : layouts_of_measures()) check_layout(layout);
}

TEST_CASE("signs of compression are turned by a key or asked for") {
  for (const Layout& layout : layouts_of_signs()) check_layout(layout);
}

TEST_CASE("ends of columns, branches, cycles and specimens side by side") {
  for (const Layout& layout : layouts_of_parts()) check_layout(layout);
}

TEST_CASE("times in minutes, hours and milliseconds become seconds") {
  for (const Layout& layout : layouts_of_times()) check_layout(layout);
}

TEST_CASE("blocks of rows become one test each, named by what stands above them") {
  Layout layout;
  layout.file = "stacked.csv";
  layout.text =
      "\"Specimen 1\"\n\"Extension (mm)\",\"Load (N)\"\n\"0\",\"0\"\n\"2\",\"1\"\n\"4\",\"3\"\n\n"
      "\"Specimen 2\"\n\"Width\",\"10\",\"mm\"\n\"Specimen 2\"\n\"Extension (mm)\",\"Load "
      "(N)\"\n\"0\",\"0\"\n\"5\",\"4\"\n\"10\",\"10\"\n,\n";
  const std::vector<Test> tests = read(layout, sizes);
  REQUIRE(tests.size() == 2);
  CHECK(tests[0].name == "stacked_Specimen_1");
  CHECK(tests[1].name == "stacked_Specimen_2");
  check_values(tests[0].first, {1, 1.05, 1.1});
  check_values(tests[1].first, {1, 1.125, 1.25});
  check_values(tests[1].stress_x, {0, 0.2, 0.5});
  REQUIRE(tests[0].notes.size() == 1);
  CHECK(tests[0].notes[0].find("2 blocks of rows") != std::string::npos);
}

TEST_CASE("a row of a table is never taken for a line between two blocks") {
  Layout layout;
  layout.file = "rows.csv";
  const std::string names = "test,strain,nominal_stress_MPa\n";
  const std::string rows = "a,0,0\na,0.125,0.2\na,0.25,0.5\n";
  layout.text = names + rows + names + rows;
  const std::vector<Test> tests = read(layout, "");
  REQUIRE(tests.size() == 2);
  check_values(tests[0].first, {1, 1.125, 1.25});
  // a row with a cell too few, with text in front, or without values right above the names
  layout.text = names + rows + "a,0.3\n" + names + rows;
  CHECK(questions(layout, "").size() == 1);
  layout.text = names + rows + "a,0.3,x\n" + names + rows;
  CHECK(questions(layout, "").size() == 1);
  layout.text = plain + "x,0.6\n" + plain;
  CHECK(questions(layout, "").size() == 1);
  layout.text = plain + "#N/A,0.6\n" + plain;
  CHECK(questions(layout, "").size() == 1);
  // units of the second block that differ
  layout.text = "strain,nominal stress\n-,MPa\n0,0\n0.1,1\nstrain,nominal stress\n-,kPa\n0,0\n";
  CHECK(questions(layout, "").size() == 1);
}

TEST_CASE("axes of a biaxial test at a given ratio on grids of their own") {
  Layout layout;
  layout.file = "ratio.csv";
  layout.text = "lx,px_MPa,lz,pz_MPa\n1,0,1,0\n1.1,1,1.02,0.5\n1.2,2,1.06,0.9\n1.3,4,,\n";
  const std::string keys =
      "kind: biaxial, stress: nominal, strain: stretch, columns: {strain_x: lx, stress_x: px_MPa, "
      "strain_z: lz, stress_z: pz_MPa}";
  CHECK(questions(layout, keys).size() == 1);  // the empty cells of one instant
  const std::vector<Test> tests = read(layout, keys + ", ratio: 0.5, fibre_angle: 10");
  REQUIRE(tests.size() == 2);
  CHECK(tests[0].kind == TestKind::biaxial);
  check_values(tests[0].first, {1, 1.1, 1.2, 1.3});
  check_values(tests[0].second, {1, 1.05, 1.1, 1.15});
  check_values(tests[0].stress_x, {0, 1, 2, 4});
  // the specimen turned by 90 degrees: its x is the other's z
  CHECK(tests[1].fibre_angle_deg == 100);
  check_values(tests[1].first, {1, 1.02, 1.06});
  check_values(tests[1].second, {1, 1.04, 1.12});
  check_values(tests[1].stress_x, {0, 0.5, 0.9});
  // the range counts along x of the specimen in both
  const std::vector<Test> cut = read(layout, keys + ", ratio: 0.5, strain_to: 0.11");
  check_values(cut[0].first, {1, 1.1});
  check_values(cut[1].first, {1, 1.02});

  // one axis alone is a test of its own
  const std::string alone =
      "kind: biaxial, stress: nominal, strain: stretch, columns: {strain_x: lx, stress_x: px_MPa}";
  CHECK(questions(layout, alone).size() == 1);
  check_values(read(layout, alone + ", ratio: 0.5")[0].second, {1, 1.05, 1.1, 1.15});
}
