// Units as laboratories write them in the heading of a column.
//
// A heading such as "Force (lbf)", "Kraft/N", "t_min" or "Position (z), mm" consists of words and
// a unit. One table of units serves the tests of a homogeneous specimen and those of a whole
// scene, so that both read the same column alike. Factors lead to the units of this program:
// a ratio to 1, lengths to mm, forces to N, stresses to MPa, times to s.
#pragma once

#include <optional>
#include <string>

namespace langer {

enum class UnitKind { ratio, length, force, stress, time };

struct MeasuredUnit {
  std::string name;  // the one name of all spellings: "N/mm2" is MPa, "Minutes" is min
  UnitKind quantity = UnitKind::ratio;
  double factor = 1;
};

// Brackets and blanks around the unit are allowed; nothing where the unit is not known.
std::optional<MeasuredUnit> measured_unit(const std::string& text);

struct Heading {
  std::string words;
  std::string unit;  // as written, without brackets; empty where there is none
};

// Separates the unit from the words. A unit that is only joined by a blank or an underscore
// ("force_N") has to be one that cannot be mistaken for the name of an axis or a specimen.
Heading split_heading(const std::string& name);

// The unit of a column of times, which may also be joined by an underscore ("t_min", "Time h").
// `unit_below` is the cell of a line of units; empty: none.
std::string time_unit_text(const std::string& name, const std::string& unit_below);

}  // namespace langer
