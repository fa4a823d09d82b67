// A measured uniaxial curve, read from CSV.
//   # comments may stand anywhere; the first other line names the columns
//   strain, cauchy_stress_MPa                     one column of deformation, one of stress, others are left alone
//   deformation   strain | strain_percent (engineering, lambda - 1), stretch (lambda)
//   stress        cauchy_stress_<unit> | nominal_stress_<unit>, unit one of Pa, kPa, MPa
// Refused, with file, line and column: text where a number should be, NaN and infinity, lines with too few or too many
// cells, stretches <= 0, fewer than two points.
#pragma once

#include <string>
#include <vector>

#include "base/csv_table.hpp"
#include "material/uniaxial.hpp"

namespace langer {

struct Curve {
  std::vector<double> strain;  // lambda - 1 [-]
  std::vector<double> stress;  // [MPa]
  StressMeasure measure = StressMeasure::cauchy;
  std::size_t size() const { return strain.size(); }
};

Curve curve_of(const CsvTable& table);                                            // throws Failure(input)
Curve read_curve(const std::string& path);                                        // throws Failure(input)
Curve parse_curve(const std::string& text, const std::string& shown_name);        // for tests
Curve between_strains(const Curve& curve, double strain_from, double strain_to);  // both ends included

}  // namespace langer
