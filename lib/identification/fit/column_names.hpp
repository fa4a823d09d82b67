// What a column's heading says of it: quantity, measure and unit.
//
// Headings are read word by word, so that "Eng. stress [MPa]", "First Piola-Kirchhoff stress
// (kPa)", "Green strain E11" and "Standardkraft in N" name their measure in whatever order the
// words stand. A heading whose words name no measure, or that two schools read differently ("S11"
// is the second Piola-Kirchhoff stress of textbooks and the Cauchy stress of Abaqus), leaves a
// question, which the key `stress` or `strain` of the item of `data` answers.
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

// Units of a stress; those from N on are units of a force.
enum class StressUnit { MPa, kPa, Pa, GPa, psi, N, mN, kN, gf, kgf, lbf };
constexpr auto names(StressUnit) {
  return std::array{"MPa", "kPa", "Pa", "GPa", "psi", "N", "mN", "kN", "gf", "kgf", "lbf"};
}

// Units of a strain; those from mm on are units of an elongation or of the length between marks.
enum class StrainUnit { fraction, percent, mm, um, cm, m, in };
constexpr auto names(StrainUnit) {
  return std::array{"fraction", "percent", "mm", "um", "cm", "m", "in"};
}

enum class TimeUnit { s, ms, min, h };
constexpr auto names(TimeUnit) { return std::array{"s", "ms", "min", "h"}; }

inline bool is_force(StressUnit unit) { return unit >= StressUnit::N; }
inline bool is_length(StrainUnit unit) { return unit >= StrainUnit::mm; }

double factor(StressUnit unit);  // to MPa or N
double factor(StrainUnit unit);  // to 1 or mm
double factor(TimeUnit unit);    // to s

struct ColumnMeaning {
  enum class Of { unknown, deformation, stress };
  Of of = Of::unknown;    // every word of the heading is understood: it may be chosen by its name
  Of noun = Of::unknown;  // what it is about, whatever its other words say
  bool lengths = false;   // an elongation: its unit has to be known
  bool position = false;  // of a crosshead: an elongation only where it starts at 0
  bool compression = false;  // "Compressive stress", "Stauchung"
  std::optional<StrainMeasure> strain;
  std::optional<StrainUnit> strain_unit;
  std::optional<StressMeasure> stress;
  std::optional<StressUnit> stress_unit;
  std::string strain_question, stress_question;  // why the words leave the measure open
  std::string foreign_unit;                      // one that is not known here
};

ColumnMeaning column_meaning(const std::string& name, const std::string& unit_below = "");

}  // namespace langer
