// Values are in mm, N, MPa, s and degrees. A dataset that says otherwise is refused: it would be
// read as what it is not.
#pragma once

#include <cctype>
#include <string>

#include <fmt/format.h>

#include "core/hdf5/h5.hpp"

namespace langer {

inline constexpr const char* house_units = "mm N MPa s deg";

// `unit`: the unit in which the values are used. The dataset's attribute `unit` or `units`, if it
// has one, must be the same. "-" and "" pass: older versions wrote them for values without a given
// unit.
inline void require_unit(const h5::Group& group, const std::string& name, const std::string& unit) {
  if (unit.empty()) return;
  for (const char* attribute : {"unit", "units"})
    if (const std::string found = group.annotation(name, attribute);
        !found.empty() && found != "-" && found != unit)
      group.refuse(name, fmt::format("values in {}", found),
                   unit == "-" ? "a pure number" : "values in " + unit,
                   "convert them: langer reads mm, N, MPa, s and degrees");
}

inline bool among_ours(const std::string& unit) {
  for (const char* ours : {"mm", "N", "MPa", "s", "Hz", "deg", "percent", "MB"})
    if (unit == ours) return true;
  return false;
}

// For values that are used with the unit that their file gives: it has to be composed of ours, so
// that one name has one unit in tables and pictures of several files.
inline void require_known_unit(const h5::Group& group, const std::string& name) {
  const std::string unit = group.unit(name);
  if (unit == "m/s" || unit == "Hz") return;  // of waves
  std::string word;
  for (const char c : unit + " ") {
    if (std::isalpha(static_cast<unsigned char>(c))) {
      word += c;
      continue;
    }
    if (!word.empty() && !among_ours(word))
      group.refuse(name, fmt::format("values in {}", unit), "values in mm, N, MPa, s, Hz or deg",
                   "convert them");
    word.clear();
  }
}

}  // namespace langer
