// A measured test: what was imposed and what was measured, in one system whatever the file says.
//   first   lambda_x (simple shear: the amount g) of each point;  second  lambda_z, in biaxial tests only
//   stress_x, stress_z [MPa] in the measure of the test; stress_z may be empty
// Read from CSV (base/csv_table.hpp) by a format that names kind, columns, measures and units, or
// by the names of the columns alone (fit/column_names.hpp); what both say must agree. Forces and
// elongations become stresses and stretches by the specimen's sizes:
//   P = F / (width thickness),  lambda = 1 + u / gauge_length
// A measure that nobody told: deformations that start at 1 are stretches, those that start at 0
// engineering strains, others are asked about; what was taken stands in `notes`. Refused, with
// file, line and column: unknown columns, text where a number should be, NaN, infinity, stretches
// <= 0, times that go back, fewer than two points, stress and strain of opposite signs.
// Cells without a value at the end of a test's columns end that test: specimens of different length
// stand side by side. Where the line of names is repeated, each block of rows is a test.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/csv_table.hpp"
#include "identification/fit/column_names.hpp"
#include "mechanics/material/states.hpp"

namespace langer {

// What a viscous specimen went through before the points that are compared; times as those, empty:
// it was at rest.
struct Past {
  std::vector<double> first, second, time;
};

struct Test {
  std::string name;
  TestKind kind = TestKind::uniaxial;
  StressMeasure measure = StressMeasure::cauchy;
  OffAxisShear shear = OffAxisShear::held;
  double fibre_angle_deg = 0;  // of the specimen, added to the law's
  double weight = 1;           // of its residuals: 1/standard deviation, or relative
  std::vector<double> first, second, stress_x, stress_z;
  std::vector<double>
      time;  // [s] of each point, what viscous laws need; empty where it was not measured
  Past before;
  std::vector<std::string> notes;  // what was taken for granted when it was read

  std::size_t points() const { return first.size(); }
  std::size_t values() const { return stress_x.size() + stress_z.size(); }
  // The stretch along z that a test imposes at a point; 1 where it imposes none.
  double second_at(std::size_t point) const {
    if (second.empty()) return 1;
    return second[point];
  }
};

// The engineering strain along x of a value of Test::first; in simple shear the amount of shear.
inline double strain_of(TestKind kind, double first) {
  if (kind == TestKind::simple_shear) return first;
  return first - 1;
}

// The inverse: the value of Test::first at a strain.
inline double deformation_at(TestKind kind, double strain) {
  if (kind == TestKind::simple_shear) return strain;
  return 1 + strain;
}

// The part of a test that is kept. Strains are lambda_x - 1 (simple shear: g), after the shift by
// `toe`
struct KeptPart {
  double strain_from = -1e300, strain_to = 1e300;
  double time_from = -1e300, time_to = 1e300;  // [s]
  double compare_from = -1e300;                // [s]; points before it become Test::before
  bool leaves_out() const {
    return strain_from > -1e300 || strain_to < 1e300 || time_from > -1e300 || time_to < 1e300 ||
           compare_from > -1e300;
  }
};

// Which cycles and branches of a record are kept, see test_cycles.hpp.
enum class KeptUntil { end, peak };
constexpr auto names(KeptUntil) { return std::array{"end", "peak"}; }
enum class KeptBranch { all, loading, unloading };
constexpr auto names(KeptBranch) { return std::array{"all", "loading", "unloading"}; }
enum class KeptCycle { all, last };
constexpr auto names(KeptCycle) { return std::array{"all", "last"}; }

struct TestCycles {
  KeptUntil until = KeptUntil::end;
  KeptBranch branch = KeptBranch::all;
  KeptCycle cycle = KeptCycle::all;
  int skip_cycles = 0;
  bool leaves_out() const {
    return until != KeptUntil::end || branch != KeptBranch::all || cycle != KeptCycle::all ||
           skip_cycles > 0;
  }
};

struct TestFormat {
  Test like;  // name, kind, shear, angle, weight; measure where neither `stress` nor the column
              // tells
  std::optional<StrainMeasure> strain;
  std::optional<StressMeasure> stress;
  std::optional<StressUnit> stress_unit;  // if the name of the column does not give it
  std::optional<StrainUnit> strain_unit;
  std::optional<TimeUnit> time_unit;
  std::optional<DecimalSign> decimal;
  // 1 or -1: factors of strains and elongations (not of stretches), and of stresses and forces
  std::optional<double> strain_sign, stress_sign;
  // columns; all empty: found by their names. strain_z and stress_z may be empty; an equibiaxial or
  // pure shear test with strain_z has a grid of its own for each axis and becomes two tests
  std::string strain_x, strain_z, stress_x, stress_z, time;
  std::map<std::string, std::string> where;  // only rows with these texts in these columns
  std::string split;                         // a column: one test per text in it
  std::string block;                         // the label of one of several blocks of rows
  // For a biaxial test whose axes have separate grids: (lambda_z - 1) / (lambda_x - 1)
  std::optional<double> ratio;
  KeptPart part;  // of its points
  TestCycles cycles;
  std::optional<double> step_at, ramp;  // [s], see StepStart in test_range.hpp
  bool viscous = false;                 // the law: then the beginning of a record matters
  std::optional<double> width, thickness, gauge_length, width_z,
      gauge_length_z;  // at rest [mm]; z: for force and elongation along z
  std::optional<double>
      toe;  // the stretch at which the stress along x first reaches this is the new rest [MPa]
  bool rest_at_start =
      false;  // what is read until the specimen first moves is no deformation and no stress
  bool normalised = false;  // stresses over the largest that is kept; forces then need no sizes
};

std::vector<Test> tests_of(const CsvTable& table,
                           const TestFormat& format);  // throws Failure(input)
std::vector<Test> read_tests(const std::string& path,
                             const TestFormat& format);  // throws Failure(input)
std::vector<Test> parse_tests(const std::string& text, const std::string& shown_name,
                              const TestFormat& format);

double largest_stress(const Test& test);
// lambda - 1 as it was written: digits beyond those that a stretch holds are rounding
double engineering_strain(double stretch);

}  // namespace langer
