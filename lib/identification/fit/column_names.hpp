// What a column's name says of it: quantity, measure and unit, in the words of machines and of
// spreadsheets.
//   cauchy_stress_kPa, Force (N), "Standardkraft [N]", "Extension / mm", Strain in %, lambda_x; a unit may stand in a line of its own
#pragma once

#include <array>
#include <optional>
#include <string>

#include "mechanics/material/states.hpp"

namespace langer {

enum class StrainMeasure { engineering, stretch, green_lagrange, log };
constexpr auto names(StrainMeasure) {
  return std::array{"engineering", "stretch", "green_lagrange", "log"};
}
enum class StressUnit { MPa, kPa, Pa, N, mN, kN };  // the last three: of a force
constexpr auto names(StressUnit) { return std::array{"MPa", "kPa", "Pa", "N", "mN", "kN"}; }
enum class StrainUnit {
  fraction,
  percent,
  mm,
  um
};  // the last two: of an elongation, or of the length between marks
constexpr auto names(StrainUnit) { return std::array{"fraction", "percent", "mm", "um"}; }

inline bool is_force(StressUnit unit) { return unit >= StressUnit::N; }
inline bool is_length(StrainUnit unit) { return unit >= StrainUnit::mm; }

struct ColumnMeaning {
  enum class Of { unknown, deformation, stress } of = Of::unknown;
  bool lengths = false;  // an elongation by its name: its unit has to be known
  std::optional<StrainMeasure> strain;
  std::optional<StrainUnit> strain_unit;
  std::optional<StressMeasure> stress;
  std::optional<StressUnit> stress_unit;
  std::string foreign_unit;  // one that is not known here
};

ColumnMeaning column_meaning(const std::string& name, const std::string& unit_below = "");

}  // namespace langer
