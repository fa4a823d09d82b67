// What looks wrong in data that can be read.
#include "identification/fit/doubts.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <filesystem>

using namespace langer;

namespace {

Test pulled(double strain_factor, double stress_factor, const std::string& name = "t") {
  Test t;
  t.name = name;
  for (int i = 0; i <= 20; ++i) {
    const double e = 0.02 * i;
    t.first.push_back(1 + strain_factor * e),
        t.stress_x.push_back(stress_factor * 0.2 * (e + 4 * e * e * e));
  }
  return t;
}

std::string all(const std::vector<Test>& tests) {
  std::string text;
  for (const std::string& one : doubts(tests)) text += one + "\n";
  return text;
}

bool holds(const std::string& said, const std::string& part) {
  return said.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("wrong units are doubted, right ones of tissues from fat to tendon are not") {
  for (double modulus : {0.01, 0.1, 1., 10., 100.}) CHECK(all({pulled(1, modulus)}) == "");
  CHECK(all({pulled(0.2, 500)}) == "");  // tendon: 66 MPa at 8 %
  CHECK(holds(all({pulled(100, 1)}),
              "strains up to 40, 4e+03 %: if the file gives percent, say strain_unit: percent"));
  CHECK(holds(all({pulled(0.01, 1)}), "if the file gives fractions, its unit is not percent"));
  CHECK(holds(all({pulled(1, 1000)}), "more than soft tissue or rubber; is the stress in kPa?"));
  CHECK(holds(all({pulled(1, 1e-6)}), "less than the softest gel; is the stress in MPa"));
  CHECK(holds(all({pulled(1, 0.3, "along"), pulled(1, 300, "across")}),
              "test across is 1000 times as stiff as along"));
  CHECK(all({pulled(1, 0.3), pulled(1, 10)}) == "");
}

TEST_CASE("an offset at rest and cycles are told, scatter is not") {
  Test t = pulled(1, 1);
  for (double& s : t.stress_x) s += 0.05;
  CHECK(holds(all({t}), "0.05 MPa at no strain"));
  t = pulled(1, 1);
  t.first.push_back(1.2), t.stress_x.push_back(0.05);
  CHECK(holds(all({t}), "the strain goes back from 0.4 to 0.2 at point 22"));
  t = pulled(1, 1);
  for (std::size_t i = 0; i < t.points(); ++i)
    t.first[i] += i % 2 ? 2e-3 : -2e-3, t.stress_x[i] += i % 3 ? 1e-3 : -1e-3;
  CHECK(all({t}) == "");
}

TEST_CASE("one rising column from compression to tension is no unloading, in either direction") {
  const auto curve = [](const std::vector<double>& strains) {
    Test t;
    t.name = "t";
    for (const double e : strains) {
      t.first.push_back(1 + e);
      t.stress_x.push_back(0.2 * e);
    }
    return t;
  };
  CHECK(all({curve({-0.1, -0.05, 0, 0.05, 0.1})}) == "");
  CHECK(all({curve({0.1, 0.05, 0, -0.05, -0.1})}) == "");
  CHECK(all({curve({0, -0.05, -0.1})}) == "");
  CHECK(all({curve({0.1, 0.099, 0.2, 0.199, 0.3})}) == "");
  CHECK(holds(all({curve({0, 0.1, 0.2, 0.1, 0})}), "goes back from 0.2 to 0.1 at point 4"));
  CHECK(holds(all({curve({0, -0.1, -0.2, -0.1, 0})}), "goes back from -0.2 to -0.1 at point 4"));
  CHECK(holds(all({curve({-0.1, 0, 0.1, 0, -0.1})}), "goes back from 0.1 to 0 at point 4"));
}

TEST_CASE("measured data of rubber and skin are not doubted") {
  const std::string folder = SOURCE_DIR "/../shared/data/";
  if (!std::filesystem::exists(folder + "treloar1944.csv")) {
    MESSAGE("no ../shared/data: skipped");
    return;
  }
  TestFormat f;
  f.strain_x = "lambda_1", f.stress_x = "P_1_MPa", f.split = "mode",
  f.stress = StressMeasure::nominal;
  CHECK(all(read_tests(folder + "treloar1944.csv", f)) == "");
  TestFormat b;
  b.like.kind = TestKind::biaxial, b.stress = StressMeasure::nominal,
  b.strain = StrainMeasure::stretch;
  b.strain_x = "lambda_1", b.strain_z = "lambda_2", b.stress_x = "P_1_MPa", b.stress_z = "P_2_MPa";
  CHECK(all(read_tests(folder + "kawabata1981_biaxial.csv", b)) == "");
  b.strain_x = "lambda_x", b.strain_z = "lambda_y", b.stress_x = "P_x_MPa", b.stress_z = "P_y_MPa",
  b.split = "protocol";
  CHECK(all(read_tests(folder + "porcine_skin_biaxial_P12AC1.csv", b)) == "");
}
