// A measured test: what was imposed and what was measured, in one system whatever the file says.
//   first   lambda_x (simple shear: the amount g) of each point;  second  lambda_z, in biaxial tests only
//   stress_x, stress_z [MPa] in the measure of the test; stress_z may be empty
// Read from CSV by a format that names kind, columns, measures and units; a unit that the column's name carries must agree.
// Refused, with file, line and column: unknown columns, text where a number should be, NaN, infinity, stretches <= 0,
// fewer than two points.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/csv_table.hpp"
#include "fit/curve.hpp"
#include "material/states.hpp"

namespace langer {

struct Test {
  std::string name;
  TestKind kind = TestKind::uniaxial;
  StressMeasure measure = StressMeasure::cauchy;
  OffAxisShear shear = OffAxisShear::held;
  double fibre_angle_deg = 0;  // of the specimen, added to the law's
  double weight = 1;           // of its residuals: 1/standard deviation, or relative
  std::vector<double> first, second, stress_x, stress_z;

  std::size_t points() const { return first.size(); }
  std::size_t values() const { return stress_x.size() + stress_z.size(); }
};

enum class StrainMeasure { engineering, stretch, green_lagrange, log };
constexpr auto names(StrainMeasure) { return std::array{"engineering", "stretch", "green_lagrange", "log"}; }
enum class StressUnit { MPa, kPa, Pa };
constexpr auto names(StressUnit) { return std::array{"MPa", "kPa", "Pa"}; }
enum class StrainUnit { fraction, percent };
constexpr auto names(StrainUnit) { return std::array{"fraction", "percent"}; }

struct TestFormat {
  Test like;  // name, kind, shear, angle, weight
  StrainMeasure strain = StrainMeasure::engineering;
  std::optional<StressUnit> stress_unit;  // where the column's name does not tell
  StrainUnit strain_unit = StrainUnit::fraction;
  std::string strain_x, strain_z, stress_x, stress_z;  // columns; strain_z and stress_z may be empty
  std::map<std::string, std::string> where;            // only rows with these texts in these columns
  std::string split;                                   // a column: one test per text in it
  double strain_from = -1e300, strain_to = 1e300;      // of lambda_x - 1 (simple shear: g)
};

std::vector<Test> tests_of(const CsvTable& table, const TestFormat& format);  // throws Failure(input)

Test test_of(const Curve& curve, const std::string& name);

double largest_stress(const Test& test);

}  // namespace langer
